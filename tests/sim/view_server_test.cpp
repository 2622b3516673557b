// The server behind --view over real sockets: whom it answers, what it refuses, and who has to wait
// for whom.

#include "sim/view/view_server.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "sim/view/loopback.h"
#include "sim/view/view_request.h"
#include "tests/support/http_client.h"
#include "tests/support/refusal.h"

namespace tenon::sim {
namespace {

using tests::get_request;
using tests::http_answer;
using tests::HttpClient;

class ViewServerTest : public ::testing::Test {
 protected:
  ViewServerTest()
      : server_under_test(
            std::make_unique<ViewServer>(listen_on_loopback(0), "<p>the page</p>", moments)),
        own_port(server_under_test->port()),
        own_host("127.0.0.1:" + std::to_string(own_port)) {}
  ~ViewServerTest() override { moments.end("{}"); }

  /// The first line of the answer, or "closed".
  [[nodiscard]] std::string status(const std::string& request) const {
    const std::string answer = http_answer(own_port, request);
    return answer.empty() ? "closed" : answer.substr(0, answer.find("\r\n"));
  }

  MomentLog moments{"run 1"};
  std::unique_ptr<ViewServer> server_under_test;
  std::uint16_t own_port;
  std::string own_host;
};

TEST_F(ViewServerTest, APageIsForNobodyElsesFrameAndNobodysCache) {
  const std::string answer = http_answer(own_port, get_request("/", own_host));
  EXPECT_EQ(answer.rfind("HTTP/1.1 200 OK\r\n", 0), 0U) << answer;
  for (const char* words :
       {"\r\nContent-Type: text/html; charset=utf-8\r\n", "\r\nCache-Control: no-store\r\n",
        "\r\nContent-Security-Policy: frame-ancestors 'none'\r\n",
        "\r\nX-Content-Type-Options: nosniff\r\n", "\r\n\r\n<p>the page</p>"}) {
    EXPECT_NE(answer.find(words), std::string::npos) << words << "\n" << answer;
  }
  EXPECT_EQ(answer.find("Access-Control"), std::string::npos);
}

TEST_F(ViewServerTest, OnlyThisMachinesOwnNamesAreAnswered) {
  const std::string port = ":" + std::to_string(own_port);
  EXPECT_EQ(status(get_request("/", "localhost" + port)), "HTTP/1.1 200 OK");
  for (const std::string& host :
       {std::string("evil.example") + port, std::string("evil.example"), std::string("127.0.0.1"),
        "127.0.0.1:" + std::to_string(own_port ^ 1U), "127.0.0.1.evil.example" + port,
        std::string()}) {
    EXPECT_EQ(status(get_request("/", host)), "HTTP/1.1 403 Forbidden") << host;
    EXPECT_EQ(status(get_request("/events", host)), "HTTP/1.1 403 Forbidden") << host;
  }
  // HTTP/1.0 needs no Host, and a page elsewhere sends its own Origin.
  EXPECT_EQ(status("GET / HTTP/1.0\r\n\r\n"), "HTTP/1.1 403 Forbidden");
  EXPECT_EQ(status(get_request("/events", own_host, "Origin: http://evil.example\r\n")),
            "HTTP/1.1 403 Forbidden");
  EXPECT_EQ(status(get_request("/events", own_host, "Origin: null\r\n")), "HTTP/1.1 403 Forbidden");
  EXPECT_EQ(status(get_request("/", own_host, "Origin: http://" + own_host + "\r\n")),
            "HTTP/1.1 200 OK");
}

TEST_F(ViewServerTest, NothingButLookingIsAllowed) {
  for (const char* method : {"HEAD", "POST", "PUT", "DELETE", "OPTIONS", "TRACE", "PATCH", "X"}) {
    std::string request = get_request("/", own_host, "Content-Length: 0\r\n");
    request.replace(0, 3, method);
    EXPECT_EQ(status(request), "HTTP/1.1 405 Method Not Allowed") << method;
  }
  EXPECT_NE(http_answer(own_port, "POST / HTTP/1.1\r\nHost: " + own_host + "\r\n\r\n")
                .find("\r\nAllow: GET\r\n"),
            std::string::npos);
  EXPECT_EQ(status(get_request("/", own_host, "Content-Length: 3\r\n") + "abc"),
            "HTTP/1.1 400 Bad Request");
  EXPECT_EQ(status(get_request("/", own_host, "Transfer-Encoding: chunked\r\n") + "0\r\n\r\n"),
            "HTTP/1.1 400 Bad Request");
  for (const char* path : {"/etc/passwd", "/../", "/events/", "//", "/favicon.ico"}) {
    EXPECT_EQ(status(get_request(path, own_host)), "HTTP/1.1 404 Not Found") << path;
  }
}

TEST_F(ViewServerTest, WhatIsNoRequestOrTooLongEndsItsOwnConnectionAlone) {
  const std::string long_text(200'000, 'a');
  const std::vector<std::string> requests = {
      "\r\n\r\n\r\n",
      "hello\r\n\r\n",
      "GET\r\n\r\n",
      std::string("\0\1\2\xFF\r\n\r\n", 8),
      "GET / HTTP/9.9\r\nHost: " + own_host + "\r\n\r\n",
      get_request("/" + long_text, own_host),
      get_request("/", own_host, "X-Long: " + long_text + "\r\n"),
      long_text};
  for (const std::string& request : requests) {
    HttpClient client(own_port);
    client.send(request);
    EXPECT_EQ(client.read_until("\r\n").find(" 200 "), std::string::npos) << request.substr(0, 40);
  }
  EXPECT_EQ(status(get_request("/", own_host)), "HTTP/1.1 200 OK");
}

TEST_F(ViewServerTest, MoreViewersThanItHasRoomForAreToldSo) {
  std::vector<std::unique_ptr<HttpClient>> viewers;
  for (std::size_t i = 0; i < kViewersMax; ++i) {
    viewers.push_back(std::make_unique<HttpClient>(own_port));
    viewers.back()->send(get_request("/events", own_host));
    EXPECT_NE(viewers.back()->read_until("event: path").find(" 200 OK"), std::string::npos) << i;
  }
  EXPECT_EQ(status(get_request("/events", own_host)), "HTTP/1.1 503 Service Unavailable");
  EXPECT_EQ(status(get_request("/", own_host)), "HTTP/1.1 200 OK");
  EXPECT_EQ(moments.present(), kViewersMax);
}

TEST_F(ViewServerTest, AViewerThatComesLateHasThePathSoFarAndWhatFollows) {
  moments.add("{\"a\":1}", {0.1, 0.0, 0.0});
  moments.add("{\"a\":2}", {0.2, 0.0, 0.0});
  HttpClient viewer(own_port);
  viewer.send(get_request("/events", own_host));
  const std::string heard = viewer.read_until("{\"a\":2}");
  EXPECT_NE(heard.find("\r\nContent-Type: text/event-stream\r\n"), std::string::npos);
  EXPECT_NE(heard.find("event: path\ndata: {\"run_id\":\"run 1\",\"path\":[0.10000,0.00000,0.00000,"
                       "0.20000,0.00000,0.00000]}\n\n"),
            std::string::npos)
      << heard;
  EXPECT_EQ(heard.find("{\"a\":1}"), std::string::npos);
  moments.add("{\"a\":3}", {0.3, 0.0, 0.0});
  EXPECT_NE(viewer.read_until("{\"a\":3}").find("data: {\"a\":3}\n\n"), std::string::npos);
  moments.end("{\"b\":4}");
  EXPECT_NE(viewer.read_all().find("event: end\ndata: {\"b\":4}\n\n"), std::string::npos);
}

//  added     1 2 3 ......................... 20000
//  sleeper   1 |            reads nothing            | the newest few
//  reader    1 2 3 4 ........................... 20000
TEST_F(ViewServerTest, AViewerThatReadsNothingDelaysNeitherTheLogNorOthers) {
  HttpClient sleeper(own_port);
  sleeper.send(get_request("/events", own_host));
  EXPECT_NE(sleeper.read_until("event: path").find(" 200 "), std::string::npos);
  const std::string filling(1000, 'x');
  constexpr int kMoments = 20'000;  // far more than the system keeps for a connection
  for (int i = 0; i < kMoments; ++i) moments.add("{\"x\":\"" + filling + "\"}", Vector3::Zero());
  HttpClient reader(own_port);
  reader.send(get_request("/events", own_host));
  EXPECT_NE(reader.read_until("event: path").find(" 200 "), std::string::npos);
  moments.add("{\"last\":1}", Vector3::Zero());
  EXPECT_NE(reader.read_until("{\"last\":1}").find("{\"last\":1}"), std::string::npos);
  // It wakes: what it missed is counted, and it has the newest.
  EXPECT_NE(sleeper.read_until("{\"last\":1}").find("{\"last\":1}"), std::string::npos);
  EXPECT_GT(moments.counts().dropped, kMoments / 2U);
  EXPECT_EQ(moments.counts().viewers, 2U);
}

TEST_F(ViewServerTest, ItEndsAlthoughViewersReadNothing) {
  HttpClient sleeper(own_port);
  sleeper.send(get_request("/events", own_host));
  HttpClient half_asked(own_port);
  half_asked.send("GET / HT");
  EXPECT_NE(sleeper.read_until("event: path").find(" 200 "), std::string::npos);
  const std::string filling(1000, 'x');
  for (int i = 0; i < 2000; ++i) moments.add("{\"x\":\"" + filling + "\"}", Vector3::Zero());
  moments.end("{}");
  server_under_test.reset();
  EXPECT_EQ(moments.present(), 0U);
}

TEST_F(ViewServerTest, APortThatIsTakenIsOneLine) {
  const std::string port = std::to_string(own_port);
  EXPECT_EQ(tests::refusal([&] { (void)listen_on_loopback(own_port); }),
            "--view " + port + ": cannot listen on 127.0.0.1:" + port +
                ": Address already in use; take another port (0 takes a free one)");
}

TEST(ViewPort, IsOfThisMachineAlone) {
  EXPECT_EQ(parse_view_port(""), 0);
  EXPECT_EQ(parse_view_port("8080"), 8080);
  EXPECT_EQ(parse_view_port("127.0.0.1:65535"), 65535);
  for (const char* text :
       {"0.0.0.0:80", "localhost:80", "10.0.0.1:80", "[::1]:80", ":80", "example.org:80", "*:80"}) {
    const std::string line = tests::refusal([&] { (void)parse_view_port(text); });
    EXPECT_EQ(line.rfind(std::string("--view ") + text + ": is for this machine alone", 0), 0U)
        << line;
  }
  for (const char* text : {"65536", "-1", "80a", " 80", "0x50", "127.0.0.1:", "eighty"}) {
    const std::string line = tests::refusal([&] { (void)parse_view_port(text); });
    EXPECT_EQ(line,
              std::string("--view ") + text + ": must be a port in [0, 65535]; 0 takes a free one");
  }
}

TEST(MomentLogTest, APathThatGrowsTooLongKeepsEveryOtherPoint) {
  MomentLog log("run");
  for (std::size_t i = 0; i <= MomentLog::kPathMax; ++i) {
    log.add("{}", {1e-3 * static_cast<double>(i), 0.0, 0.0});
    log.add("{}", {1e-3 * static_cast<double>(i) + 1e-4, 0.0, 0.0});  // has hardly moved
  }
  MomentLog::Viewer viewer;
  std::string text;
  ASSERT_TRUE(log.take(viewer, text));
  EXPECT_NE(text.find("[0.00000,0.00000,0.00000,0.00200,0.00000,0.00000,0.00400,"),
            std::string::npos)
      << text.substr(0, 200);
  EXPECT_NE(text.find("3.99800,0.00000,0.00000,4.00000,0.00000,0.00000]}"), std::string::npos)
      << text.substr(text.size() - 100);
}

}  // namespace
}  // namespace tenon::sim
