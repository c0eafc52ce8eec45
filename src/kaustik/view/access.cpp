#include "kaustik/view/access.h"

#include <fmt/format.h>
#include <sys/random.h>

#include <algorithm>
#include <array>
#include <cctype>

#include "kaustik/base/error.h"
#include "kaustik/view/request_error.h"

namespace kaustik::view {
namespace {

std::string in_lower_case(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return char(std::tolower(c)); });
  return text;
}

/// The name of "name:port" or "[address]:port"; "" for what is neither.
std::string name_of_host(const std::string& host) {
  const size_t end = host.starts_with('[') ? host.find(']') : host.find(':');
  const bool has_brackets = host.starts_with('[');
  if (has_brackets && end == std::string::npos) return {};
  const size_t name_end = end == std::string::npos ? host.size() : end;
  const std::string rest = host.substr(std::min(host.size(), name_end + (has_brackets ? 1 : 0)));
  const bool has_port =
      rest.size() >= 2 && rest.size() <= 6 && rest[0] == ':' &&
      std::all_of(rest.begin() + 1, rest.end(), [](char c) { return c >= '0' && c <= '9'; });
  if (!rest.empty() && !has_port) return {};
  return in_lower_case(has_brackets ? host.substr(1, name_end - 1) : host.substr(0, name_end));
}

bool is_address(const std::string& name) {
  const bool is_v6 = name.find(':') != std::string::npos;
  return !name.empty() && std::all_of(name.begin(), name.end(), [&](unsigned char c) {
    return is_v6 ? std::isxdigit(c) || c == ':' || c == '.' : std::isdigit(c) || c == '.';
  });
}

/// The value of a cookie among "a=1; b=2"; absent: it is not there.
std::optional<std::string_view> cookie_value(std::string_view cookies, std::string_view name) {
  while (!cookies.empty()) {
    const size_t end = std::min(cookies.find(';'), cookies.size());
    std::string_view pair = cookies.substr(0, end);
    cookies.remove_prefix(std::min(cookies.size(), end + 1));
    while (pair.starts_with(' ')) pair.remove_prefix(1);
    if (pair.size() > name.size() && pair.starts_with(name) && pair[name.size()] == '=')
      return pair.substr(name.size() + 1);
  }
  return std::nullopt;
}

}  // namespace

std::string random_token() {
  std::array<unsigned char, 16> bytes{};
  if (::getrandom(bytes.data(), bytes.size(), 0) != ssize_t(bytes.size()))
    throw Error(ErrorKind::system, "the system has no random numbers for the session's token",
                "see whether /dev/urandom can be read");
  std::string text;
  for (const unsigned char byte : bytes) text += fmt::format("{:02x}", byte);
  return text;
}

bool equal_in_constant_time(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  volatile unsigned char difference = 0;
  for (size_t i = 0; i < a.size(); ++i)
    difference = static_cast<unsigned char>(
        difference | (static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i])));
  return difference == 0;
}

Access::Access(std::string token, std::string address, uint16_t port)
    : token_(std::move(token)),
      address_(in_lower_case(std::move(address))),
      cookie_name_(fmt::format("kaustik_view_{}", port)) {}

bool Access::is_own_host(const std::string& host) const {
  const std::string name = name_of_host(host);
  if (name == "localhost" || name == "127.0.0.1" || name == "::1") return true;
  if (name.empty()) return false;
  const bool listens_to_all = address_ == "0.0.0.0" || address_ == "::";
  // Names may be pointed here by those who own them; addresses may not.
  return name == address_ || (listens_to_all && is_address(name));
}

void Access::check_sender(const HttpRequest& request, bool is_page) const {
  const std::string* host = request.header("host");
  if (!host || request.count("host") != 1 || !is_own_host(*host))
    throw RequestError(403, "the request is for another host than this one",
                       "use the address that the program has told");
  if (const std::string* origin = request.header("origin")) {
    const std::string own = in_lower_case(*host), sender = in_lower_case(*origin);
    if (request.count("origin") != 1 || (sender != "http://" + own && sender != "https://" + own))
      throw RequestError(403, "the request comes from another site's page",
                         "use the page that this server gives");
  }
  if (const std::string* site = request.header("sec-fetch-site")) {
    const std::string* mode = request.header("sec-fetch-mode");
    const std::string* destination = request.header("sec-fetch-dest");
    const bool is_link =
        is_page && mode && *mode == "navigate" && destination && *destination == "document";
    if (*site != "same-origin" && *site != "none" && !is_link)
      throw RequestError(403, "the request comes from another site's page",
                         "use the page that this server gives");
  }
}

void Access::check_session(const HttpRequest& request) const {
  const std::string* cookies = request.header("cookie");
  const auto value = cookies ? cookie_value(*cookies, cookie_name_) : std::nullopt;
  if (!value || !equal_in_constant_time(*value, token_))
    throw RequestError(403, "the request has no session",
                       "open the address that the program has told, with its #token=…");
}

std::string Access::cookie_for(std::string_view token) const {
  if (!equal_in_constant_time(token, token_))
    throw RequestError(403, "the token is not this server's",
                       "open the address that the program has told last");
  return fmt::format("{}={}; HttpOnly; SameSite=Strict; Path=/", cookie_name_, token_);
}

}  // namespace kaustik::view
