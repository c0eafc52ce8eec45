// Clients that are many, slow, gone or wrong.

#include <atomic>
#include <random>
#include <thread>

#include "tests/view/shown_scene.h"

namespace kaustik::test {
namespace {

using namespace std::chrono_literals;

TEST(ViewClients, TwoSeeTheSame) {
  ShownScene shown;
  HttpClient one(shown.port()), two(shown.port());
  ASSERT_TRUE(shown.wait_until_done());
  for (HttpClient* client : {&one, &two}) client->send(shown.request("GET", "/frame?after=0"));
  const ClientResponse first = one.response(), second = two.response();
  EXPECT_EQ(first.status, 200);
  EXPECT_EQ(first.body, second.body);
  // What one changes the other is told.
  two.send(shown.request("GET", "/events"));
  EXPECT_NE(two.until("event: state"), "");
  one.send(shown.request("POST", "/command", "{\"set\":{\"ball.radius\":0.25}}"));
  EXPECT_EQ(one.response().status, 200);
  EXPECT_NE(two.until("\"revision\":2"), "");
}

TEST(ViewClients, WhoStopsReadingHoldsUpNobody) {
  view::ViewSettings settings = shown_settings();
  settings.engine.session.passes = 1'000'000;
  settings.limits.write_time = 300ms;
  settings.limits.connections = 2;
  ShownScene shown(settings);
  ASSERT_TRUE(shown.server().engine().wait_for_snapshot(0, 60s));
  // Asks for more than the buffers of the system hold, and reads nothing.
  HttpClient lazy(shown.port(), 4096);
  std::string requests;
  for (int i = 0; i < 4000; ++i) requests += shown.request("GET", "/frame?after=0&format=f32");
  std::thread sender([&] { lazy.send(requests); });
  const uint64_t before = shown.server().engine().snapshot()->number;
  EXPECT_EQ(shown.ask("GET", "/state").status, 200);
  EXPECT_TRUE(shown.server().engine().wait_for_snapshot(before + 3, 60s));
  // It is dropped: then its sending fails, and another one may come.
  sender.join();
  int status = 0;
  for (int i = 0; i < 500 && status != 200; ++i) {
    status = shown.ask_apart(shown.request("GET", "/state")).status;
    if (status != 200) std::this_thread::sleep_for(10ms);
  }
  EXPECT_EQ(status, 200);
}

TEST(ViewClients, ListenersThatStopReadingAreDropped) {
  view::HttpLimits limits;
  limits.queued_event_bytes = 100'000;
  view::HttpServer server("127.0.0.1", 0, limits);
  std::shared_ptr<view::EventSink> sink;
  std::atomic<bool> has_sink = false, is_open = true;
  server.start(
      [&](view::HttpRequest, std::shared_ptr<view::HttpReply> reply) {
        sink = reply->stream();
        has_sink = true;
      },
      1ms,
      [&] {
        if (!has_sink) return;
        sink->send(std::make_shared<const std::string>(50'000, 'x'));
        is_open = sink->is_open();
      });
  HttpClient lazy(server.port(), 4096);
  lazy.send("GET / HTTP/1.1\r\n\r\n");
  for (int i = 0; i < 6000 && is_open; ++i) std::this_thread::sleep_for(10ms);
  EXPECT_FALSE(is_open);
  server.stop();
  sink = nullptr;
}

TEST(ViewClients, PollsOfThoseWhoAreGoneAreForgotten) {
  view::ViewSettings settings = shown_settings();
  settings.limits.connections = 4;
  ShownScene shown(settings);
  ASSERT_TRUE(shown.wait_until_done());
  const std::string poll = shown.request(
      "GET", "/frame?after=" + std::to_string(shown.server().engine().snapshot()->number));
  for (int i = 0; i < 20; ++i) {
    // At most three wait beside the one that is let in.
    HttpClient client(shown.port());
    EXPECT_TRUE(client.send(poll)) << i;
    EXPECT_EQ(client.receive(20ms), "") << i;
  }
  for (int i = 0; i < 100 && shown.ask_apart(shown.request("GET", "/state")).status != 200; ++i)
    std::this_thread::sleep_for(10ms);
  EXPECT_EQ(shown.ask_apart(shown.request("GET", "/state")).status, 200);
}

TEST(ViewClients, NoMoreThanThereMayBe) {
  view::ViewSettings settings = shown_settings();
  settings.limits.connections = 5;
  ShownScene shown(settings);
  std::vector<std::unique_ptr<HttpClient>> idle;
  for (int i = 0; i < 4; ++i) {
    idle.push_back(std::make_unique<HttpClient>(shown.port()));
    idle.back()->send(shown.request("GET", "/state"));
    EXPECT_EQ(idle.back()->response().status, 200);
  }
  HttpClient one_more(shown.port());
  EXPECT_EQ(one_more.response().status, 503);
  EXPECT_EQ(shown.ask("GET", "/state").status, 200);
  idle.clear();
  for (int i = 0; i < 100 && shown.ask_apart(shown.request("GET", "/state")).status != 200; ++i)
    std::this_thread::sleep_for(10ms);
  EXPECT_EQ(shown.ask_apart(shown.request("GET", "/state")).status, 200);
}

TEST(ViewClients, EightMayListen) {
  ShownScene shown;
  std::vector<std::unique_ptr<HttpClient>> listeners;
  for (int i = 0; i < 8; ++i) {
    listeners.push_back(std::make_unique<HttpClient>(shown.port()));
    listeners.back()->send(shown.request("GET", "/events"));
    EXPECT_NE(listeners.back()->until("event: state"), "");
  }
  EXPECT_EQ(shown.ask("GET", "/events").status, 503);
  listeners.pop_back();
  std::unique_ptr<HttpClient> next;
  for (int i = 0; i < 100; ++i) {
    next = std::make_unique<HttpClient>(shown.port());
    next->send(shown.request("GET", "/events"));
    if (next->until("\r\n\r\n").find("event-stream") != std::string::npos) return;
    std::this_thread::sleep_for(10ms);
  }
  FAIL() << "the place of the one that went stays taken";
}

TEST(ViewClients, SlowHeadersAndBodiesAreCut) {
  view::ViewSettings settings = shown_settings();
  settings.limits.read_time = 200ms;
  ShownScene shown(settings);
  HttpClient silent(shown.port()), slow_header(shown.port()), slow_body(shown.port());
  slow_header.send("GET /state HTTP/1.1\r\nHost: ");
  slow_body.send("POST /session HTTP/1.1\r\nHost: localhost\r\nContent-Length: 100\r\n\r\n{");
  EXPECT_TRUE(silent.ends());
  EXPECT_TRUE(slow_header.ends());
  EXPECT_TRUE(slow_body.ends());
  EXPECT_EQ(shown.ask_apart(shown.request("GET", "/state")).status, 200);
}

TEST(ViewClients, TooLongIsRefused) {
  ShownScene shown;
  const std::string host = "Host: " + shown.host() + "\r\n";
  EXPECT_EQ(shown.ask_apart("GET /" + std::string(20 << 10, 'a') + " HTTP/1.1\r\n" + host + "\r\n")
                .status,
            431);
  EXPECT_EQ(
      shown.ask_apart("GET / HTTP/1.1\r\n" + host + "X: " + std::string(20 << 10, 'a') + "\r\n\r\n")
          .status,
      431);
  EXPECT_EQ(
      shown.ask_apart("POST /command HTTP/1.1\r\n" + host + "Content-Length: 1073741824\r\n\r\n{")
          .status,
      413);
  std::string chunks = "POST /command HTTP/1.1\r\n" + host + "Transfer-Encoding: chunked\r\n\r\n";
  for (int i = 0; i < 20; ++i) chunks += "10000\r\n" + std::string(0x10000, ' ') + "\r\n";
  EXPECT_EQ(shown.ask_apart(chunks).status, 413);
  // A mebibyte may come, and is no JSON.
  EXPECT_EQ(shown.ask("POST", "/command", std::string((1 << 20) - 1, ' ') + "x").status, 400);
  EXPECT_EQ(shown.ask("POST", "/command", std::string(100'000, '[')).status, 400);
  EXPECT_EQ(shown.ask("GET", "/state").status, 200);
}

TEST(ViewClients, ServersStartAgainOnTheSamePort) {
  auto first = std::make_unique<ShownScene>();
  view::ViewSettings settings = shown_settings();
  settings.port = first->port();
  settings.token = first->server().token();
  const std::string request = first->request("GET", "/state");
  HttpClient connected(first->port());
  connected.send(request);
  EXPECT_EQ(connected.response().status, 200);
  HttpClient waiting(first->port());
  waiting.send(first->request("GET", "/frame?after=999999"));
  first = nullptr;
  EXPECT_TRUE(connected.ends());
  ShownScene second(settings);
  EXPECT_EQ(second.port(), settings.port);
  // With the same token the same session goes on.
  EXPECT_EQ(second.ask_apart(request).status, 200);
}

std::string mutated(std::string text, std::mt19937& generator) {
  const auto below = [&](size_t bound) { return size_t(generator() % bound); };
  for (size_t k = 0, changes = 1 + below(4); k < changes; ++k) {
    const size_t at = below(text.size());
    switch (below(6)) {
      case 0:
        text[at] = char(below(256));
        break;
      case 1:
        text.erase(at, 1 + below(8));
        break;
      case 2:
        text.insert(at, std::string(1 + below(4), char(below(256))));
        break;
      case 3:
        text.insert(at, text.substr(below(text.size()), below(60)));
        break;
      case 4:
        text[at] = "\r\n {}[]\":,0-9%&=?/.;"[below(20)];
        break;
      case 5:
        text.resize(std::max<size_t>(1, at));
        break;
    }
    if (text.empty()) text = "x";
  }
  return text;
}

/// Valid requests with bytes that are changed, taken out, put in, doubled or cut off. The server
/// answers each by HTTP or ends the connection, and goes on.
void send_mutations(int count, uint32_t seed) {
  view::ViewSettings settings = shown_settings();
  settings.limits.read_time = 200ms;
  const TemporaryFolder folder;
  settings.output_folder = folder.path("");
  ShownScene shown(settings);
  const std::vector<std::string> valid = {
      shown.request("GET", "/"),
      shown.request("GET", "/state"),
      shown.request("GET", "/frame?after=0&layer=direct&format=rgb9e5&width=10"),
      shown.request("GET", "/pixel?x=3&y=4"),
      shown.request("GET", "/region?x=1&y=2&width=3&height=4"),
      shown.request("GET", "/parameters"),
      shown.request("POST", "/session", "{\"token\": \"" + shown.server().token() + "\"}"),
      shown.request("POST", "/command",
                    "{\"camera\": {\"origin\": [0, -4, 2], \"target\": [0, 0, 0.5], \"up\": [0, 0, "
                    "1], \"fov\": 45}}"),
      shown.request("POST", "/command", "{\"set\": {\"ball.radius\": 0.25}}"),
      shown.request("POST", "/command", "{\"integrator\": \"path\"}"),
      shown.request("POST", "/command", "{\"do\": \"resume\"}"),
      shown.request("POST", "/command", "{\"save\": {\"name\": \"a.pfm\"}}")};
  std::mt19937 generator(seed);
  int answered = 0;
  struct Sent {
    std::unique_ptr<HttpClient> client;
    std::string text;
  };
  // Many at once: those that the server waits for the rest of take its patience only together.
  std::vector<Sent> sent;
  for (int i = 0; i < count; ++i) {
    std::string text = mutated(valid[generator() % valid.size()], generator);
    sent.push_back({std::make_unique<HttpClient>(shown.port()), text});
    sent.back().client->send(text);
    if (sent.size() < 40 && i + 1 < count) continue;
    for (const Sent& one : sent) {
      const ClientResponse response = one.client->response();
      if (response.status != 0) ++answered;
      ASSERT_TRUE(response.status == 0 || (response.status >= 200 && response.status < 600))
          << one.text;
      ASSERT_NE(response.status, 500) << one.text << '\n' << response.body;
    }
    sent.clear();
  }
  EXPECT_GT(answered, count / 4);
  EXPECT_EQ(shown.ask_apart(shown.request("GET", "/state")).status, 200);
  for (const auto& entry : std::filesystem::directory_iterator(folder.path("")))
    EXPECT_EQ(entry.path().extension(), ".pfm") << entry.path();
}

TEST(ViewClients, MutatedRequestsHarmNothing) { send_mutations(1000, 1); }
TEST(ViewClients, MutatedRequestsHarmNothingLong) { send_mutations(10'000, 2); }

}  // namespace
}  // namespace kaustik::test
