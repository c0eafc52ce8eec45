#pragma once
// A small scene, served.

#include <gtest/gtest.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "kaustik/loader/mitsuba_xml.h"
#include "kaustik/view/view_server.h"
#include "tests/support/scripted_integrator.h"
#include "tests/support/temporary_folder.h"
#include "tests/view/http_client.h"

namespace kaustik::test {

inline constexpr int shown_width = 24, shown_height = 18;

inline Description shown_scene() {
  return parse_mitsuba_xml(
      "<scene version=\"3.0.0\"><integrator type=\"path\"/><sensor type=\"perspective\">"
      "<float name=\"fov\" value=\"45\"/><transform name=\"to_world\"><lookat origin=\"0,-4,2\" "
      "target=\"0,0,0.5\" up=\"0,0,1\"/></transform>" +
          film_of(shown_width, shown_height) + "</sensor>" + room +
          "<shape type=\"sphere\" id=\"ball\"><float name=\"radius\" value=\"0.3\"/>"
          "<point name=\"center\" x=\"1\" y=\"0\" z=\"0.5\"/></shape></scene>",
      "test.xml", "");
}

inline SessionSettings shown_session() {
  SessionSettings session;
  session.passes = 4;
  session.samples_per_pass = 1;
  session.threads = 2;
  return session;
}

inline view::ViewSettings shown_settings() {
  view::ViewSettings settings;
  settings.scene = "test";
  settings.engine.session = shown_session();
  settings.engine.snapshot_interval_s = 0;
  settings.engine.rest_s = 0;
  return settings;
}

/// A server and a client that it has let in.
class ShownScene {
 public:
  explicit ShownScene(view::ViewSettings settings = shown_settings(),
                      Description description = shown_scene())
      : server_(std::move(description), std::move(settings)), client_(server_.port()) {
    cookie_ = login(client_);
  }

  /// Of a render that the test steers.
  explicit ShownScene(view::ShownSession session)
      : server_(std::move(session), shown_scene(), shown_settings()), client_(server_.port()) {
    cookie_ = login(client_);
  }

  view::ViewServer& server() { return server_; }
  uint16_t port() const { return server_.port(); }
  std::string host() const { return "127.0.0.1:" + std::to_string(port()); }
  std::string cookie() const { return cookie_; }

  /// With the headers that the page's requests have, and these.
  std::string request(const std::string& method, const std::string& target,
                      const std::string& body = "", const std::string& headers = "") const {
    std::string text = method + " " + target + " HTTP/1.1\r\nHost: " + host() + "\r\n";
    if (!cookie_.empty()) text += "Cookie: " + cookie_ + "\r\n";
    if (method == "POST")
      text += "Content-Type: application/json\r\nContent-Length: " + std::to_string(body.size()) +
              "\r\n";
    return text + headers + "\r\n" + body;
  }
  ClientResponse ask(const std::string& method, const std::string& target,
                     const std::string& body = "") {
    client_.send(request(method, target, body));
    return client_.response();
  }
  /// Sent on a connection of its own.
  ClientResponse ask_apart(const std::string& text) const {
    HttpClient client(port());
    client.send(text);
    return client.response();
  }
  nlohmann::json get(const std::string& target) {
    const ClientResponse response = ask("GET", target);
    EXPECT_EQ(response.status, 200) << target << ": " << response.body;
    return nlohmann::json::parse(response.body, nullptr, false);
  }
  ClientResponse command(const nlohmann::json& json) {
    return ask("POST", "/command", json.dump());
  }
  bool wait_until_done() const {
    return server_.engine().wait_until_done(std::chrono::seconds(120));
  }
  HttpClient& client() { return client_; }

 private:
  std::string login(HttpClient& client) {
    client.send(request("POST", "/session", "{\"token\": \"" + server_.token() + "\"}"));
    const ClientResponse response = client.response();
    EXPECT_EQ(response.status, 204) << response.body;
    const std::string cookie = response.header("set-cookie");
    return cookie.substr(0, cookie.find(';'));
  }

  view::ViewServer server_;
  HttpClient client_;
  std::string cookie_;
};

}  // namespace kaustik::test
