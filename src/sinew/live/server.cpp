#include "sinew/live/server.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <deque>
#include <list>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <random>
#include <set>
#include <thread>

#include "sinew/error/input_error.hpp"
#include "sinew/io/document.hpp"

namespace sinew::live {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using tcp = asio::ip::tcp;
using Error = beast::error_code;

namespace {

constexpr std::size_t kAhead = 2;              ///< frames sent that have not been drawn yet
constexpr std::chrono::seconds kPatience{10};  ///< for a request
constexpr std::size_t kMostVisits = 4 * Server::kMostPages;
constexpr std::size_t kLongestHeader = 32 * 1024;  ///< browsers send the cookies of all ports of a host
constexpr int kReported = 50;                      ///< refusals that are told, so that none fills a disk
constexpr std::chrono::milliseconds kPause{100};   ///< before the next visitor, where none can be let in

/// "localhost:8000" without the port.
std::string host_of(std::string_view authority) {
  const std::size_t colon = authority.rfind(':');
  const bool port = colon != std::string_view::npos && authority.find(']', colon) == std::string_view::npos;
  return std::string(authority.substr(0, port ? colon : authority.size()));
}

/// In a time that does not tell how much of it is right.
bool same(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  unsigned char off = 0;
  for (std::size_t i = 0; i < a.size(); ++i) off |= static_cast<unsigned char>(a[i] ^ b[i]);
  return off == 0;
}

/// The value of `token` in "/live?token=...", if there is one.
std::optional<std::string_view> token_of(std::string_view target) {
  const std::size_t at = target.find("?token=");
  return at == std::string_view::npos ? std::nullopt : std::optional(target.substr(at + 7));
}

/// What cookie has the token: browsers share cookies among all ports of a host, so the port is in its name.
std::string cookie_name(std::string_view authority) {
  std::string name = "sinew_";
  for (const char letter : authority.substr(host_of(authority).size()))
    if (letter >= '0' && letter <= '9') name += letter;
  return name;
}

/// Whether "a=1; b=2" has a cookie of this name and value.
bool has_cookie(std::string_view cookies, const std::string& name, std::string_view value) {
  bool found = false;
  while (!cookies.empty()) {
    const std::size_t end = std::min(cookies.find(';'), cookies.size());
    std::string_view cookie = cookies.substr(0, end);
    cookies.remove_prefix(std::min(end + 1, cookies.size()));
    cookie.remove_prefix(std::min(cookie.find_first_not_of(' '), cookie.size()));
    const bool named = cookie.size() > name.size() && cookie.starts_with(name) && cookie[name.size()] == '=';
    if (named && same(cookie.substr(name.size() + 1), value)) found = true;
  }
  return found;
}

std::string_view text_of(beast::string_view own) { return {own.data(), own.size()}; }

asio::ip::address numeric(const std::string& address) {
  Error error;
  asio::ip::address own = asio::ip::make_address(address, error);
  if (error)
    throw InputError({.path = "--bind",
                      .value = address,
                      .rule = "is no numeric address",
                      .remedy = "leave it out, for this machine alone, or give the number of an interface, as in "
                                "`--bind 192.168.1.5`"});
  return own;
}

/// "192.168.1.5", "[::1]".
bool is_numeric(std::string host) {
  if (host.size() > 2 && host.front() == '[' && host.back() == ']') host = host.substr(1, host.size() - 2);
  Error error;
  asio::ip::make_address(host, error);
  return !error;
}

struct Frame {
  Bytes bytes;
  long number = 0;
};

using HttpRequest = http::request<http::empty_body>;

}  // namespace

struct Server::Own {
  Own(const Place& at, Behind what)
      : place(at), behind(std::move(what)), loopback(is_loopback(at.address)), acceptor(context), pause(context) {}

  class Page;
  class Visit;

  void run();
  void accept();
  void offer_newest();
  void tell_shown();
  /// Why a visitor may not come in; empty: may.
  std::string refusal(const HttpRequest& request, bool live) const;
  bool knows_token(const HttpRequest& request) const;
  /// Whether a browser opens the page in a window of its own, by an address with the token.
  bool opens_window(const HttpRequest& request) const;
  void report(const std::string& text) {
    if (++reported > kReported) return;
    if (behind.report) behind.report(text + (reported == kReported ? " (and so on: no more is told)" : ""));
  }

  Place place;
  Behind behind;
  bool loopback;
  std::list<Visit*> visits;  ///< the newest last
  int reported = 0;
  asio::io_context context{1};
  tcp::acceptor acceptor;
  asio::steady_timer pause;
  std::set<std::shared_ptr<Page>> pages;
  const Page* holding = nullptr;  ///< whose hand is at a body
  Frame last;

  std::mutex mutex;  ///< of what follows
  Frame newest;
  bool offered = true;  ///< it has been; else that is under way

  std::thread thread;
};

/// A page that looks on. Everything happens on the server's thread.
class Server::Own::Page : public std::enable_shared_from_this<Page> {
 public:
  Page(Own& own, tcp::socket socket) : own_(own), socket_(std::move(socket)) {}

  void open(const HttpRequest& request) {
    websocket::stream_base::timeout patience = websocket::stream_base::timeout::suggested(beast::role_type::server);
    patience.idle_timeout = std::chrono::seconds(60);
    socket_.set_option(patience);
    socket_.read_message_max(kLongestRequest);
    socket_.auto_fragment(false);
    socket_.write_buffer_bytes(1 << 16);
    socket_.set_option(websocket::stream_base::decorator([](websocket::response_type& response) {
      response.set(http::field::server, "");
    }));  // else Beast tells its own
    socket_.async_accept(request, [self = shared_from_this()](Error error) {
      if (error) return;
      if (self->own_.pages.size() >= kMostPages) {
        self->own_.report("a page was refused: there are many already");
        self->socket_.async_close({websocket::close_code::try_again_later, "too many pages"}, [self](Error) {});
        return;
      }
      self->scene_ = std::make_shared<const std::string>(self->own_.behind.scene());
      self->own_.pages.insert(self);
      self->frame_ = self->own_.last;
      self->write();
      self->read();
    });
  }

  void offer(const Frame& frame) {
    frame_ = frame;
    write();
  }
  const Show& shown() const { return shown_; }

 private:
  /// With all that it held and showed.
  void leave() {
    if (own_.pages.erase(shared_from_this()) == 0) return;
    if (own_.holding == this) {
      own_.holding = nullptr;
      own_.behind.take(Release{});
    }
    own_.tell_shown();
  }

  void read() {
    socket_.async_read(buffer_, [self = shared_from_this()](Error error, std::size_t) {
      if (error) {
        if (error == websocket::error::message_too_big || error == websocket::error::buffer_overflow)
          self->own_.report("a page was closed: its message was too long");
        return self->leave();
      }
      self->take(beast::buffers_to_string(self->buffer_.data()));
      self->buffer_.consume(self->buffer_.size());
      self->read();
    });
  }

  void take(const std::string& text) {
    try {
      const Request request = own_.behind.read(text);
      if (const Ack* ack = std::get_if<Ack>(&request)) {
        const auto drawn = std::find(sent_.rbegin(), sent_.rend(), ack->frame);
        sent_.erase(sent_.begin(), drawn.base());
        return write();
      }
      if (const Show* show = std::get_if<Show>(&request)) {
        shown_ = *show;
        return own_.tell_shown();
      }
      if (std::holds_alternative<Grab>(request)) own_.holding = this;
      if (std::holds_alternative<Release>(request) && own_.holding == this) own_.holding = nullptr;
      own_.behind.take(request);
    } catch (const std::exception& error) {
      own_.report(fmt::format("a message was refused: {}", error.what()));
      answer_ = nlohmann::json{{"refused", error.what()}}.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
      write();
    }
  }

  /// The next thing that is to be sent, if nothing is on its way.
  void write() {
    if (writing_) return;
    if (scene_) return send(std::move(scene_), true);
    if (!answer_.empty()) return send(std::make_shared<const std::string>(std::exchange(answer_, {})), false);
    if (!frame_.bytes || sent_.size() >= kAhead) return;
    sent_.push_back(frame_.number);
    send(std::exchange(frame_.bytes, nullptr), true);
  }

  void send(Bytes bytes, bool binary) {
    writing_ = true;
    socket_.binary(binary);
    const auto buffer = asio::buffer(*bytes);
    socket_.async_write(buffer, [self = shared_from_this(), kept = std::move(bytes)](Error error, std::size_t) {
      self->writing_ = false;
      if (error) return self->leave();
      self->write();
    });
  }

  Own& own_;
  websocket::stream<beast::tcp_stream> socket_;
  beast::flat_buffer buffer_{kLongestRequest + 1024};
  Bytes scene_;
  Frame frame_;  ///< the newest that has not been sent
  Show shown_;
  std::string answer_;
  std::deque<long> sent_;  ///< numbers of frames that have not been drawn yet
  bool writing_ = false;
};

/// Somebody who asks for the page, or to look on.
class Server::Own::Visit : public std::enable_shared_from_this<Visit> {
 public:
  Visit(Own& own, tcp::socket socket)
      : own_(own), stream_(std::move(socket)), place_(own_.visits.insert(own_.visits.end(), this)) {}
  ~Visit() { own_.visits.erase(place_); }

  void read() {
    parser_.emplace();
    parser_->header_limit(kLongestHeader);
    parser_->body_limit(0);
    stream_.expires_after(kPatience);
    http::async_read(stream_, buffer_, *parser_, [self = shared_from_this()](Error error, std::size_t) {
      self->asks_ = false;
      if (!error) return self->answer();
      if (error == http::error::header_limit || error == http::error::buffer_overflow)
        self->send(http::status::request_header_fields_too_large, "text/plain; charset=utf-8",
                   "The request is too long. Delete the cookies of this host, and come again.\n");
    });
  }

  /// Whether its request has not come yet.
  bool asks() const { return asks_; }
  void close() { stream_.close(); }

 private:
  void answer() {
    const HttpRequest& request = parser_->get();
    const std::string_view target = text_of(request.target());
    const std::string_view path = target.substr(0, target.find('?'));
    const bool live = websocket::is_upgrade(request);
    const std::string refusal = own_.refusal(request, live);
    if (!refusal.empty()) {
      own_.report(refusal);
      return send(http::status::forbidden, "text/plain; charset=utf-8",
                  refusal + "\nOpen the address that `sinew view` printed, and allow its cookie.\n");
    }
    if (live && path == "/live") {
      stream_.expires_never();
      std::make_shared<Page>(own_, stream_.release_socket())->open(request);
      return;
    }
    if (request.method() != http::verb::get || path != "/")
      return send(http::status::not_found, "text/plain; charset=utf-8", "There is nothing here.\n");
    if (own_.opens_window(request))
      return send(http::status::see_other, "text/plain; charset=utf-8", "",
                  cookie_name(text_of(request[http::field::host])));
    send(http::status::ok, "text/html; charset=utf-8", own_.behind.page);
  }

  /// With a cookie's name the token goes along, and the page's address without it.
  void send(http::status status, const char* type, const std::string& text, const std::string& cookie = "") {
    auto response = std::make_shared<http::response<http::string_body>>(status, 11);
    response->set(http::field::content_type, type);
    response->set(http::field::cache_control, "no-store");
    response->set("Referrer-Policy", "no-referrer");
    response->set("X-Content-Type-Options", "nosniff");
    response->set("Content-Security-Policy",
                  "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data: blob:; "
                  "media-src blob:; connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors " +
                      own_.place.frame_ancestors);
    if (!cookie.empty()) {
      response->set(http::field::location, "/");
      response->set(http::field::set_cookie, cookie + "=" + own_.place.token + "; Path=/; HttpOnly; SameSite=Lax");
    }
    response->keep_alive(false);
    response->body() = text;
    response->prepare_payload();
    stream_.expires_after(kPatience);
    http::async_write(stream_, *response, [self = shared_from_this(), response](Error, std::size_t) {
      Error ignored;
      self->stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
    });
  }

  Own& own_;
  beast::tcp_stream stream_;
  beast::flat_buffer buffer_{kLongestHeader + 1024};
  std::optional<http::request_parser<http::empty_body>> parser_;
  std::list<Visit*>::iterator place_;
  bool asks_ = true;
};

std::string Server::Own::refusal(const HttpRequest& request, bool live) const {
  const std::string_view authority = text_of(request[http::field::host]);
  const std::string host = host_of(authority);
  const bool known = host == "localhost" || host == "127.0.0.1" || host == "[::1]" || host == place.address ||
                     host == "[" + place.address + "]" || (!loopback && is_numeric(host));
  if (!known) return fmt::format("refused: the host {} is not this machine", io::show(host));
  const std::string_view origin = text_of(request[http::field::origin]);
  if (live && !origin.empty() && origin != "http://" + std::string(authority) &&
      origin != "https://" + std::string(authority))
    return fmt::format("refused: a page of {} wants to look on", io::show(std::string(origin)));
  if (!knows_token(request)) return "refused: the token is missing, or not the one of this run";
  return "";
}

bool Server::Own::knows_token(const HttpRequest& request) const {
  if (const auto told = token_of(text_of(request.target()))) return same(*told, place.token);
  return has_cookie(text_of(request[http::field::cookie]), cookie_name(text_of(request[http::field::host])),
                    place.token);
}

bool Server::Own::opens_window(const HttpRequest& request) const {
  if (!token_of(text_of(request.target()))) return false;
  const std::string_view destination = text_of(request["Sec-Fetch-Dest"]);
  if (!destination.empty()) return destination == "document";
  // Browsers tell no destination to addresses that they do not trust, as those of a network. A frame that is allowed
  // may then be one.
  const bool browser = text_of(request[http::field::accept]).find("text/html") != std::string_view::npos;
  return browser && place.frame_ancestors == "'none'";
}

void Server::Own::accept() {
  acceptor.async_accept([this](Error error, tcp::socket socket) {
    if (error == asio::error::operation_aborted) return;
    if (error) {  // no descriptors left, say
      pause.expires_after(kPause);
      return pause.async_wait([this](Error ended) {
        if (!ended) accept();
      });
    }
    accept();
    if (visits.size() >= kMostVisits) {  // who is slow to ask makes room
      const auto slow = std::find_if(visits.begin(), visits.end(), [](const Visit* visit) { return visit->asks(); });
      if (slow == visits.end()) return;
      (*slow)->close();
    }
    Error ignored;
    socket.set_option(tcp::no_delay(true), ignored);
    std::make_shared<Visit>(*this, std::move(socket))->read();
  });
}

/// What goes wrong for one page, as when there is no memory for its scene, is no end for the others.
void Server::Own::run() {
  for (;;) {
    try {
      context.run();
      return;
    } catch (const std::exception& error) {
      report(fmt::format("a page was left: {}", error.what()));
    }
  }
}

void Server::Own::offer_newest() {
  {
    const std::lock_guard lock(mutex);
    last = newest;
    offered = true;
  }
  for (const std::shared_ptr<Page>& page : std::set(pages)) page->offer(last);
}

void Server::Own::tell_shown() {
  Show all;
  for (const std::shared_ptr<Page>& page : pages) all = together(std::move(all), page->shown());
  behind.take(all);
}

bool is_loopback(const std::string& address) { return numeric(address).is_loopback(); }

Server::Server(const Place& place, Behind behind) : own_(std::make_unique<Own>(place, std::move(behind))) {
  Error error;
  const tcp::endpoint endpoint(numeric(place.address), static_cast<unsigned short>(place.port));
  own_->acceptor.open(endpoint.protocol(), error);
  if (!error) own_->acceptor.set_option(asio::socket_base::reuse_address(true), error);
  if (!error) own_->acceptor.bind(endpoint, error);
  if (!error) own_->acceptor.listen(asio::socket_base::max_listen_connections, error);
  const bool taken = error == asio::error::address_in_use || error == asio::error::access_denied;
  if (error)
    throw InputError({.path = taken ? "--port" : "--bind",
                      .value = fmt::format("{}:{}", place.address, place.port),
                      .rule = "cannot be listened on: " + error.message(),
                      .remedy = taken ? "choose another --port, or leave it out"
                                      : "give an address of this machine, or leave --bind out"});
  own_->accept();
  own_->thread = std::thread([own = own_.get()] { own->run(); });
}

Server::~Server() {
  own_->context.stop();
  own_->thread.join();
  own_->pages.clear();
}

int Server::port() const { return own_->acceptor.local_endpoint().port(); }

void Server::publish(Bytes frame, long number) {
  {
    const std::lock_guard lock(own_->mutex);
    own_->newest = {std::move(frame), number};
    if (!std::exchange(own_->offered, false)) return;  // one that is under way takes it along
  }
  asio::post(own_->context, [own = own_.get()] { own->offer_newest(); });
}

std::string random_token() {
  std::random_device random;
  std::string all;
  for (int i = 0; i < 4; ++i) all += fmt::format("{:08x}", static_cast<std::uint32_t>(random()));
  return all;
}

}  // namespace sinew::live
