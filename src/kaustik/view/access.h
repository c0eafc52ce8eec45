#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "kaustik/view/http_message.h"

namespace kaustik::view {

/// 128 random bits in hexadecimal digits. Throws Error(system) if the machine has none to give.
std::string random_token();

/// Whether both are the same, in a time that tells only their lengths.
bool equal_in_constant_time(std::string_view a, std::string_view b);

/// Who may ask for what: browsers run the pages of strangers, which may send requests to this
/// machine, too (docs/guides/live_view.md). Every request passes check_sender(); all but those for
/// the page itself check_session().
class Access {
 public:
  /// `address`: that the server listens to, as text; `port` tells the cookies of several servers of
  /// one host apart.
  Access(std::string token, std::string address, uint16_t port);

  const std::string& token() const { return token_; }
  /// Refuses names of the host that are not this machine's own (a stranger's name may be made to
  /// point here), and requests of other sites' pages. `is_page`: it is for the page itself, to
  /// which others may link. Throws RequestError.
  void check_sender(const HttpRequest& request, bool is_page) const;
  /// Throws RequestError if the request has not the session's cookie.
  void check_session(const HttpRequest& request) const;
  /// The header that makes a browser have it, in exchange for the token. Throws RequestError if
  /// that is another.
  std::string cookie_for(std::string_view token) const;

 private:
  bool is_own_host(const std::string& host) const;

  std::string token_, address_, cookie_name_;
};

}  // namespace kaustik::view
