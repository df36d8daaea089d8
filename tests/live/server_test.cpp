// The server: who may come, what happens to those who say too much, and to those who do not listen.
#include "sinew/live/server.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <random>

#include "sinew/error/input_error.hpp"
#include "sinew/runs/loaded_scene.hpp"

namespace sinew::live {
namespace {

namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using tcp = boost::asio::ip::tcp;
using testing::AllOf;
using testing::HasSubstr;

const std::string kToken = "0123456789abcdef";

/// A server in front of nothing: what is asked is counted.
class PageServer : public testing::Test {
 protected:
  PageServer() {
    Behind behind;
    behind.page = "<!doctype html>the page";
    behind.scene = [] { return std::string("scene"); };
    behind.read = [this](std::string_view text) { return read_request(text, loaded_.model); };
    behind.take = [this](const Request& request) {
      ++taken_;
      const std::lock_guard lock(mutex_);
      if (const Show* show = std::get_if<Show>(&request)) shown_ = *show;
      if (std::holds_alternative<Grab>(request)) held_ = true;
      if (std::holds_alternative<Release>(request)) held_ = false;
    };
    behind.report = [this](const std::string& text) {
      const std::lock_guard lock(mutex_);
      reports_.push_back(text);
    };
    server_ = std::make_unique<Server>(Place{"127.0.0.1", 0, kToken}, behind);
    host_ = "127.0.0.1:" + std::to_string(server_->port());
  }

  tcp::socket socket() {
    tcp::socket own(context_);
    own.connect({boost::asio::ip::make_address("127.0.0.1"), static_cast<unsigned short>(server_->port())});
    return own;
  }

  using Fields = std::vector<std::pair<std::string, std::string>>;
  http::response<http::string_body> get(const std::string& target, const std::string& host, const Fields& fields = {}) {
    tcp::socket own = socket();
    http::request<http::empty_body> request(http::verb::get, target, 11);
    request.set(http::field::host, host);
    for (const auto& [name, value] : fields) request.set(name, value);
    http::write(own, request);
    beast::flat_buffer buffer;
    http::response<http::string_body> response;
    http::read(own, buffer, response);
    return response;
  }

  using Page = websocket::stream<tcp::socket>;
  /// Comes in, or throws.
  std::unique_ptr<Page> come(const std::string& token = kToken, const std::string& origin = "",
                             const std::string& host = "") {
    auto page = std::make_unique<Page>(socket());
    page->set_option(websocket::stream_base::decorator([&](websocket::request_type& request) {
      if (!origin.empty()) request.set(http::field::origin, origin);
    }));
    page->handshake(host.empty() ? host_ : host, "/live?token=" + token);
    return page;
  }

  static std::string next(Page& page) {
    beast::flat_buffer buffer;
    page.read(buffer);
    return beast::buffers_to_string(buffer.data());
  }

  static void say(Page& page, const std::string& text) {
    page.text(true);
    page.write(boost::asio::buffer(text));
  }

  /// What is true within a minute.
  template <class Holds>
  void wait_until(const Holds& holds) {
    const auto until = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    for (;;) {
      {
        const std::lock_guard lock(mutex_);
        if (holds()) return;
      }
      ASSERT_LT(std::chrono::steady_clock::now(), until);
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }

  void publish(int number) { server_->publish(std::make_shared<const std::string>(std::to_string(number)), number); }

  std::vector<std::string> reports() {
    const std::lock_guard lock(mutex_);
    return reports_;
  }

  runs::LoadedScene loaded_ = runs::load(io::read_scene(SINEW_SOURCE_DIR "/examples/finger.yaml"));
  boost::asio::io_context context_;
  std::atomic<int> taken_ = 0;
  std::mutex mutex_;
  std::vector<std::string> reports_;
  Show shown_;
  bool held_ = false;
  std::unique_ptr<Server> server_;
  std::string host_;
};

TEST_F(PageServer, GivesThePageToWhoKnowsTheToken) {
  const auto response = get("/?token=" + kToken, host_);
  EXPECT_EQ(response.result_int(), 200u);
  EXPECT_EQ(response.body(), "<!doctype html>the page");
  EXPECT_EQ(get("/?token=" + kToken, "localhost:1234").result_int(), 200u);  // a tunnel of SSH
  EXPECT_EQ(get("/etc/passwd?token=" + kToken, host_).result_int(), 404u);
}

TEST_F(PageServer, RefusesWhoDoesNot) {
  EXPECT_EQ(get("/", host_).result_int(), 403u);
  EXPECT_EQ(get("/?token=0123456789abcdee", host_).result_int(), 403u);
  EXPECT_EQ(get("/?token=" + kToken + "0", host_).result_int(), 403u);
  const auto rebound = get("/?token=" + kToken, "evil.example:" + std::to_string(server_->port()));
  EXPECT_EQ(rebound.result_int(), 403u);
  EXPECT_THAT(rebound.body(), HasSubstr("not this machine"));
  EXPECT_THROW(come("wrong"), beast::system_error);
  EXPECT_THROW(come(kToken, "http://evil.example"), beast::system_error);
  EXPECT_THROW(come(kToken, "null"), beast::system_error);
  EXPECT_THROW(come(kToken, "", "evil.example"), beast::system_error);
  EXPECT_NO_THROW(come(kToken, "http://" + host_));
  EXPECT_EQ(reports().size(), 8u);
}

TEST_F(PageServer, AWindowGoesOnWithACookieAndWithoutTheToken) {
  const auto sent_on = get("/?token=" + kToken, host_, {{"Sec-Fetch-Dest", "document"}});
  EXPECT_EQ(sent_on.result_int(), 303u);
  EXPECT_EQ(sent_on[http::field::location], "/");
  const std::string port = std::to_string(server_->port());
  EXPECT_EQ(sent_on[http::field::set_cookie], "sinew_" + port + "=" + kToken + "; Path=/; HttpOnly; SameSite=Lax");
  const std::string cookie = "sinew_" + port + "=" + kToken;
  EXPECT_EQ(get("/", host_, {{"Cookie", cookie}}).result_int(), 200u);
  EXPECT_EQ(get("/", host_, {{"Cookie", "theme=dark;  " + cookie + "; other=1"}}).result_int(), 200u);
  EXPECT_EQ(get("/", "localhost:9", {{"Cookie", "sinew_9=" + kToken}}).result_int(), 200u);  // by a tunnel
  for (const std::string& wrong :
       {"sinew_" + port + "=0123456789abcdee", "sinew_" + port + "=", "sinew_" + port, "sinew_9=" + kToken,
        "x" + cookie, "sinew_" + port + "1=" + kToken, cookie + "0", std::string(";;; ; ="), std::string()})
    EXPECT_EQ(get("/", host_, {{"Cookie", wrong}}).result_int(), 403u) << wrong;
  // A token in the address alone is judged, so that who opens a wrong one is told.
  EXPECT_EQ(get("/?token=0123456789abcdee", host_, {{"Cookie", cookie}}).result_int(), 403u);
  EXPECT_EQ(get("/", "evil.example:" + port, {{"Cookie", cookie}}).result_int(), 403u);
  // A frame keeps its address; so does who is no browser. Browsers in a network tell no destination.
  EXPECT_EQ(get("/?token=" + kToken, host_, {{"Sec-Fetch-Dest", "iframe"}, {"Accept", "text/html"}}).result_int(),
            200u);
  EXPECT_EQ(get("/?token=" + kToken, host_, {{"Accept", "*/*"}}).result_int(), 200u);
  EXPECT_EQ(get("/?token=" + kToken, host_, {{"Accept", "text/html,*/*"}}).result_int(), 303u);
  // The cookie of a page of another port does not let that page look on.
  Page page(socket());
  page.set_option(websocket::stream_base::decorator([&](websocket::request_type& request) {
    request.set(http::field::cookie, cookie);
    request.set(http::field::origin, "http://127.0.0.1:1");
  }));
  EXPECT_THROW(page.handshake(host_, "/live"), beast::system_error);
  Page ours(socket());
  ours.set_option(websocket::stream_base::decorator([&](websocket::request_type& request) {
    request.set(http::field::cookie, cookie);
    request.set(http::field::origin, "http://" + host_);
  }));
  EXPECT_NO_THROW(ours.handshake(host_, "/live"));
  // What is too long is answered.
  EXPECT_EQ(get("/", host_, {{"Cookie", std::string(40'000, 'a')}}).result_int(), 431u);
}

TEST_F(PageServer, SaysNotWhatItIsAndWhoMayFrameIt) {
  const auto answer = get("/?token=" + kToken, host_);
  EXPECT_EQ(answer.count(http::field::server), 0u);
  EXPECT_THAT(std::string(answer["Content-Security-Policy"]), HasSubstr("; frame-ancestors 'none'"));
  Page page(socket());
  websocket::response_type shaken;
  page.handshake(shaken, host_, "/live?token=" + kToken);
  EXPECT_EQ(shaken[http::field::server], "");

  Behind behind;
  behind.page = "the page";
  Place place{"127.0.0.1", 0, kToken, "http://localhost:8888"};
  server_ = std::make_unique<Server>(place, behind);
  const auto framed = get("/?token=" + kToken, host_, {{"Accept", "text/html"}});
  EXPECT_EQ(framed.result_int(), 200u);  // it may be in a frame
  EXPECT_THAT(std::string(framed["Content-Security-Policy"]), HasSubstr("; frame-ancestors http://localhost:8888"));
}

TEST_F(PageServer, RequestsThatAreNeverEndedHoldNobody) {
  const auto page = come();
  EXPECT_EQ(next(*page), "scene");
  std::vector<tcp::socket> half;
  for (int i = 0; i < 200; ++i) {
    half.push_back(socket());
    boost::asio::write(half.back(), boost::asio::buffer("GET /?token=" + kToken + " HTTP/1.1\r\nHost: loc"));
  }
  // A page opens at once, and another goes on.
  for (int i = 1; i <= 20; ++i) {
    const auto start = std::chrono::steady_clock::now();
    EXPECT_EQ(get("/?token=" + kToken, host_).result_int(), 200u);
    EXPECT_EQ(next(*come()), "scene");
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(1));
    publish(i);
    EXPECT_EQ(next(*page), std::to_string(i));
    say(*page, R"({"do": "ack", "frame": )" + std::to_string(i) + "}");
  }
}

TEST_F(PageServer, SendsTheSceneThenFramesAsTheyAreDrawn) {
  const auto page = come();
  EXPECT_EQ(next(*page), "scene");
  publish(1);
  EXPECT_EQ(next(*page), "1");
  publish(2);
  EXPECT_EQ(next(*page), "2");
  // Two have not been drawn: others wait, and only the last of them is kept.
  for (int i = 3; i < 50; ++i) publish(i);
  say(*page, R"({"do": "ack", "frame": 1})");
  EXPECT_EQ(next(*page), "49");
  // Two are on their way again, 2 and 49; one of yesterday makes no room.
  publish(50);
  say(*page, R"({"do": "ack", "frame": 1})");
  say(*page, R"({"do": "dance"})");
  EXPECT_THAT(next(*page), HasSubstr("refused"));
  say(*page, R"({"do": "ack", "frame": 49})");
  EXPECT_EQ(next(*page), "50");
}

TEST_F(PageServer, ShowsWhatAnyPageShows) {
  auto one = come();
  next(*one);
  say(*one, R"({"do": "show", "solids": "von_mises", "rods": "", "energies": false})");
  const auto other = come();
  next(*other);
  say(*other, R"({"do": "show", "solids": "volume_ratio", "rods": "bending", "energies": true})");
  wait_until([&] { return shown_.solids.size() == 2 && shown_.rods.size() == 1 && shown_.energies; });
  one.reset();
  wait_until([&] { return shown_.solids == std::vector<std::string>{"volume_ratio"}; });
}

TEST_F(PageServer, WhoLeavesHoldsNothing) {
  const std::string grip = R"({"do": "grip", "solid": "finger", "node": 3, "to": [0, 0, 0.1], "stiffness": 20})";
  auto one = come();
  next(*one);
  say(*one, grip);
  wait_until([&] { return held_; });
  auto other = come();
  next(*other);
  other.reset();
  EXPECT_EQ(next(*come()), "scene");  // by now it is known that it left
  EXPECT_TRUE(held_);
  one.reset();
  wait_until([&] { return !held_; });
}

TEST_F(PageServer, AnswersWhatItDoesNotTakeAndGoesOn) {
  const auto page = come();
  next(*page);
  say(*page, R"({"do": "dance"})");
  EXPECT_THAT(next(*page), HasSubstr("refused"));
  say(*page, R"({"do": "play"})");
  say(*page, "\"");
  EXPECT_THAT(next(*page), HasSubstr("refused"));
  EXPECT_EQ(taken_, 1);
}

TEST_F(PageServer, ClosesOnMessagesThatAreTooLong) {
  const auto page = come();
  next(*page);
  say(*page, std::string(kLongestRequest + 1, ' '));
  EXPECT_THROW(
      {
        for (;;) next(*page);
      },
      beast::system_error);
  EXPECT_EQ(get("/?token=" + kToken, host_).result_int(), 200u);  // still there
  EXPECT_THAT(reports(), testing::Contains(HasSubstr("too long")));
}

TEST_F(PageServer, SurvivesWhatIsNoHttp) {
  std::mt19937 random(3);
  for (int i = 0; i < 200; ++i) {
    tcp::socket own = socket();
    std::string rubbish(1 + random() % 2000, '\0');
    for (char& letter : rubbish) letter = static_cast<char>(random());
    if (i % 3 == 0) rubbish = "GET /live?token=" + kToken + " HTTP/1.1\r\nUpgrade: websocket\r\n" + rubbish;
    if (i % 3 == 1) rubbish = "GET /" + std::string(20000, 'a') + " HTTP/1.1\r\n\r\n";
    beast::error_code ignored;
    boost::asio::write(own, boost::asio::buffer(rubbish), ignored);
  }
  EXPECT_EQ(get("/?token=" + kToken, host_).result_int(), 200u);
}

TEST_F(PageServer, SurvivesAHundredThousandMessages) {
  std::mt19937 random(5);
  const auto page = come();
  next(*page);
  const std::string seed = R"({"do": "tell", "actuator": "pull", "value": 0.001})";
  std::thread listener([&page] {
    try {
      for (;;) next(*page);
    } catch (const beast::system_error&) {
    }
  });
  for (int i = 0; i < 100000; ++i) {
    std::string text = seed;
    for (auto k = random() % 3; k > 0; --k) text[random() % text.size()] = static_cast<char>(32 + random() % 95);
    say(*page, text);
  }
  say(*page, R"({"do": "play"})");
  const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (taken_ < 20000 && std::chrono::steady_clock::now() < until) std::this_thread::yield();
  EXPECT_GE(taken_, 20000);
  EXPECT_LE(reports().size(), 50u);  // a few are told, a disk is not filled
  EXPECT_EQ(get("/?token=" + kToken, host_).result_int(), 200u);
  beast::error_code ignored;
  page->next_layer().shutdown(tcp::socket::shutdown_both, ignored);
  listener.join();
}

TEST_F(PageServer, HasRoomForSoManyAndNoMore) {
  std::vector<std::unique_ptr<Page>> pages;
  for (int i = 0; i < Server::kMostPages; ++i) {
    pages.push_back(come());
    EXPECT_EQ(next(*pages.back()), "scene");
  }
  const auto more = come();
  EXPECT_THROW(next(*more), beast::system_error);
  pages.clear();  // those who leave make room
  for (int tries = 0;; ++tries) {
    const auto again = come();
    beast::flat_buffer buffer;
    beast::error_code error;
    again->read(buffer, error);
    if (!error) break;
    ASSERT_LT(tries, 1000);
  }
}

TEST(Place, OfAllInterfacesIsReachedByNumbersAlone) {
  Behind behind;
  behind.page = "the page";
  const Server server({"0.0.0.0", 0, kToken}, behind);
  const auto status = [&](const std::string& host) {
    boost::asio::io_context context;
    tcp::socket own(context);
    own.connect({boost::asio::ip::make_address("127.0.0.1"), static_cast<unsigned short>(server.port())});
    http::request<http::empty_body> request(http::verb::get, "/?token=" + kToken, 11);
    request.set(http::field::host, host + ":" + std::to_string(server.port()));
    http::write(own, request);
    beast::flat_buffer buffer;
    http::response<http::string_body> response;
    http::read(own, buffer, response);
    return response.result_int();
  };
  EXPECT_EQ(status("192.0.2.7"), 200u);
  EXPECT_EQ(status("[2001:db8::7]"), 200u);
  EXPECT_EQ(status("robot.example"), 403u);
}

TEST(Place, ThatCannotBeListenedOnIsTold) {
  const auto refusal = [](const Place& place) -> std::string {
    try {
      const Server server(place, {});
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(refusal({"localhost", 0, kToken}), HasSubstr("is no numeric address"));
  EXPECT_THAT(refusal({"203.0.113.1", 0, kToken}), AllOf(HasSubstr("--bind"), HasSubstr("cannot be listened on")));
  const Server first({"127.0.0.1", 0, kToken}, {});
  EXPECT_THAT(refusal({"127.0.0.1", first.port(), kToken}),
              AllOf(HasSubstr("--port"), HasSubstr("cannot be listened on")));
  EXPECT_EQ(random_token().size(), 32u);
  EXPECT_NE(random_token(), random_token());
}

}  // namespace
}  // namespace sinew::live
