// Serves the page and, over a WebSocket, what it shows and asks for.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "sinew/live/request.hpp"
#include "sinew/live/stage.hpp"

namespace sinew::live {

/// Who may come: those who know the token, from pages of this very address. Hosts other than this machine's own name
/// (localhost, 127.0.0.1, [::1]) and `address` are refused, so that no other site's name can stand for it; numeric
/// ones, which no name server can point elsewhere, are let in where `address` is not of the loopback.
///
/// Who opens `/?token=...` in a browser is sent on to `/` with the token as a cookie, so that neither the address bar
/// nor the history keeps it. In a frame of another page, where browsers send no cookies, it stays in the address.
struct Place {
  std::string address = "127.0.0.1";  ///< numeric; of one of this machine's interfaces
  int port = 0;                       ///< 0: any that is free
  std::string token;                  ///< not empty; letters and digits
  /// Who may show the page in a frame of theirs, as `frame-ancestors` of Content-Security-Policy (W3C CSP 3, 6.4.2).
  std::string frame_ancestors = "'none'";
};

/// What is behind the page. Called on the server's thread.
struct Behind {
  std::string page;                                     ///< HTML, all in one
  std::function<std::string()> scene;                   ///< the first message to everyone who comes
  std::function<Request(std::string_view)> read;        ///< throws InputError
  std::function<void(const Request&)> take;             ///< but acks, which are the server's own
  std::function<void(const std::string& text)> report;  ///< of what was refused, for people
};

/// Frames go to every page that has drawn the last ones; one that is slow gets the newest when it can, and keeps
/// nobody waiting. What is behind is asked to show what any page shows. At most kMostPages at a time.
class Server {
 public:
  static constexpr int kMostPages = 32;

  /// Listens, on a thread of its own. Throws InputError where it cannot.
  Server(const Place& place, Behind behind);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  int port() const;
  /// For every page; from any thread. Pages acknowledge it by its number.
  void publish(Bytes frame, long number);

 private:
  struct Own;
  std::unique_ptr<Own> own_;
};

/// Whether it is of this machine alone. Throws InputError where it is no numeric address.
bool is_loopback(const std::string& address);

/// 128 random bits as 32 hexadecimal digits.
std::string random_token();

}  // namespace sinew::live
