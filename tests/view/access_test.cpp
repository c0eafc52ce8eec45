// Who is let in, and who is not.

#include "kaustik/view/access.h"

#include "kaustik/view/assets.h"
#include "tests/view/shown_scene.h"

namespace kaustik::test {
namespace {

using namespace std::chrono_literals;

TEST(ViewAccess, TokensAreRandomAndCompared) {
  const std::string token = view::random_token();
  EXPECT_EQ(token.size(), 32u);
  EXPECT_NE(token, view::random_token());
  EXPECT_TRUE(view::equal_in_constant_time(token, token));
  std::string other = token;
  other.back() = other.back() == 'a' ? 'b' : 'a';
  EXPECT_FALSE(view::equal_in_constant_time(token, other));
  EXPECT_FALSE(view::equal_in_constant_time(token, token.substr(1)));
}

TEST(ViewAccess, ListensToThisMachineAlone) {
  ShownScene shown;
  EXPECT_TRUE(shown.server().is_local());
  EXPECT_EQ(shown.server().url(), "http://" + shown.host() + "/#token=" + shown.server().token());
  // Loopback has more addresses than that one.
  const int other = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(shown.port());
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK + 1);
  EXPECT_NE(::connect(other, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  ::close(other);
}

TEST(ViewAccess, NothingWithoutASession) {
  ShownScene shown;
  const std::string head = " HTTP/1.1\r\nHost: " + shown.host() + "\r\n";
  for (const char* path : {"/state", "/events", "/frame", "/pixel?x=0&y=0",
                           "/region?x=0&y=0&width=1&height=1", "/parameters"}) {
    EXPECT_EQ(shown.ask_apart("GET " + std::string(path) + head + "\r\n").status, 403) << path;
    std::string forged = shown.cookie();
    forged.back() = forged.back() == '0' ? '1' : '0';
    EXPECT_EQ(shown.ask_apart("GET " + std::string(path) + head + "Cookie: " + forged + "\r\n\r\n")
                  .status,
              403)
        << path;
  }
  EXPECT_EQ(shown
                .ask_apart("POST /command" + head +
                           "Content-Type: application/json\r\nContent-Length: 13\r\n\r\n"
                           "{\"do\":\"stop\"}")
                .status,
            403);
  EXPECT_EQ(shown.ask("GET", "/state").status, 200);
}

TEST(ViewAccess, CookiesAreForTokens) {
  ShownScene shown;
  EXPECT_EQ(
      shown.ask("POST", "/session", "{\"token\": \"00000000000000000000000000000000\"}").status,
      403);
  EXPECT_EQ(shown.ask("POST", "/session", "{\"token\": 1}").status, 400);
  EXPECT_EQ(shown.ask("POST", "/session", "{}").status, 400);
  EXPECT_EQ(shown.ask("POST", "/session", "[]").status, 400);
  const ClientResponse let_in =
      shown.ask("POST", "/session", "{\"token\": \"" + shown.server().token() + "\"}");
  EXPECT_EQ(let_in.status, 204);
  EXPECT_NE(let_in.header("set-cookie").find("HttpOnly"), std::string::npos);
  EXPECT_NE(let_in.header("set-cookie").find("SameSite=Strict"), std::string::npos);
  // Among others.
  const std::string head = "GET /state HTTP/1.1\r\nHost: " + shown.host() + "\r\nCookie: a=b; ";
  EXPECT_EQ(shown.ask_apart(head + shown.cookie() + "; c=d\r\n\r\n").status, 200);
}

TEST(ViewAccess, OtherNamesOfTheHostAreRefused) {
  ShownScene shown;
  const std::string port = ":" + std::to_string(shown.port());
  const auto asked = [&](const std::string& host) {
    return shown
        .ask_apart("GET / HTTP/1.1\r\n" + (host.empty() ? "" : "Host: " + host + "\r\n") + "\r\n")
        .status;
  };
  for (const std::string host : {"127.0.0.1", "localhost", "LocalHost", "[::1]"}) {
    EXPECT_EQ(asked(host + port), 200) << host;
    // Through ssh -L the page has another port.
    EXPECT_EQ(asked(host + ":9000"), 200) << host;
  }
  for (const std::string host : {"evil.example", "127.0.0.1.evil.example", "localhost.evil.example",
                                 "evil.example#localhost", "[::1", "::1", "127.0.0.1:80:80",
                                 "127.0.0.1:x", "[::1]x", "0.0.0.0", "192.168.0.1", ""})
    EXPECT_EQ(asked(host), 403) << host;
  EXPECT_EQ(
      shown.ask_apart("GET / HTTP/1.1\r\nHost: localhost\r\nHost: evil.example\r\n\r\n").status,
      403);
}

TEST(ViewAccess, OtherSitesAreRefused) {
  ShownScene shown;
  const auto asked = [&](const std::string& target, const std::string& headers) {
    return shown.ask_apart(shown.request("GET", target, "", headers)).status;
  };
  EXPECT_EQ(asked("/state", "Origin: http://" + shown.host() + "\r\n"), 200);
  for (const std::string origin :
       {"http://evil.example", "null", "http://127.0.0.1:1", "http://localhost", "file://", ""})
    EXPECT_EQ(asked("/state", "Origin: " + origin + "\r\n"), 403) << origin;
  EXPECT_EQ(asked("/state", "Sec-Fetch-Site: same-origin\r\n"), 200);
  EXPECT_EQ(asked("/state", "Sec-Fetch-Site: none\r\n"), 200);
  for (const std::string site : {"cross-site", "same-site"})
    for (const std::string target : {"/state", "/", "/command"})
      EXPECT_EQ(asked(target, "Sec-Fetch-Site: " + site + "\r\n"), 403) << site << target;
  // Others may link to the page, but not to what it asks for, nor frame it.
  const std::string link =
      "Sec-Fetch-Site: cross-site\r\nSec-Fetch-Mode: navigate\r\nSec-Fetch-Dest: ";
  EXPECT_EQ(asked("/", link + "document\r\n"), 200);
  EXPECT_EQ(asked("/state", link + "document\r\n"), 403);
  EXPECT_EQ(asked("/", link + "iframe\r\n"), 403);
}

TEST(ViewAccess, FormsOfOtherSitesAreNoCommands) {
  ShownScene shown;
  for (const char* type : {"text/plain", "application/x-www-form-urlencoded", ""}) {
    std::string text = shown.request("POST", "/command", "{\"do\":\"stop\"}");
    const std::string json = "application/json";
    text.replace(text.find(json), json.size(), type);
    EXPECT_EQ(shown.ask_apart(text).status, 415) << type;
  }
}

TEST(ViewAccess, NoPathLeadsOut) {
  ShownScene shown;
  for (const char* target :
       {"/../etc/passwd", "/..", "/%2e%2e/etc/passwd", "/..%2fetc/passwd", "//etc/passwd",
        "/./index.html", "/assets/../index.html", "/index.html/", "/index.html%00", "/\\..\\x",
        "/etc/passwd", "/INDEX.HTML"})
    EXPECT_EQ(shown.ask_apart(shown.request("GET", target)).status, 404) << target;
  EXPECT_EQ(shown.ask_apart(shown.request("GET", "http://" + shown.host() + "/")).status, 400);
  EXPECT_EQ(shown.ask_apart(shown.request("GET", "*")).status, 400);
  for (const view::Asset& asset : view::assets())
    EXPECT_EQ(shown.ask_apart(shown.request("GET", "/" + std::string(asset.name))).body,
              std::string(asset.bytes));
}

TEST(ViewAccess, OnAllAddressesNumbersAreNamesOfTheHost) {
  view::ViewSettings settings = shown_settings();
  settings.address = "0.0.0.0";
  ShownScene shown(settings);
  EXPECT_FALSE(shown.server().is_local());
  const auto asked = [&](const std::string& host) {
    return shown.ask_apart("GET / HTTP/1.1\r\nHost: " + host + "\r\n\r\n").status;
  };
  EXPECT_EQ(asked("192.168.0.1:80"), 200);
  EXPECT_EQ(asked("evil.example"), 403);
  EXPECT_EQ(asked("1.evil.example"), 403);
}

TEST(ViewAccess, AddressesThatCannotBeHad) {
  view::ViewSettings settings = shown_settings();
  settings.address = "localhost.example";
  EXPECT_THROW(view::ViewServer(shown_scene(), settings), Error);
  settings.address = "203.0.113.7";
  EXPECT_THROW(view::ViewServer(shown_scene(), settings), Error);
  ShownScene shown;
  settings = shown_settings();
  settings.port = shown.port();
  EXPECT_THROW(view::ViewServer(shown_scene(), settings), Error);
}

}  // namespace
}  // namespace kaustik::test
