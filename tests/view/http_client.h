#pragma once
// A client that may misbehave: bytes in, bytes out.

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <map>
#include <string>
#include <utility>

namespace kaustik::test {

struct ClientResponse {
  int status = 0;                              ///< 0: the connection ended before there was one
  std::map<std::string, std::string> headers;  ///< names in lower case
  std::string body;
  std::string header(const std::string& name) const {
    const auto found = headers.find(name);
    return found == headers.end() ? "" : found->second;
  }
};

class HttpClient {
 public:
  explicit HttpClient(uint16_t port, int receive_buffer = 0) {
    socket_ = ::socket(AF_INET, SOCK_STREAM, 0);
    if (receive_buffer > 0)
      ::setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &receive_buffer, sizeof receive_buffer);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    is_connected_ =
        ::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  }
  ~HttpClient() { close(); }
  HttpClient(const HttpClient&) = delete;
  HttpClient& operator=(const HttpClient&) = delete;

  bool is_connected() const { return is_connected_; }
  void close() {
    if (socket_ >= 0) ::close(socket_);
    socket_ = -1;
  }
  /// False: the other side has closed.
  bool send(const std::string& bytes) {
    size_t sent = 0;
    while (sent < bytes.size()) {
      const ssize_t count = ::send(socket_, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
      if (count <= 0) return false;
      sent += size_t(count);
    }
    return true;
  }
  /// What comes next; "": nothing within the time, or the end.
  std::string receive(std::chrono::milliseconds timeout = std::chrono::seconds(60)) {
    pollfd wanted{socket_, POLLIN, 0};
    if (::poll(&wanted, 1, int(timeout.count())) <= 0) return {};
    std::string bytes(64 << 10, '\0');
    const ssize_t count = ::recv(socket_, bytes.data(), bytes.size(), 0);
    has_ended_ = count <= 0;
    bytes.resize(count > 0 ? size_t(count) : 0);
    return bytes;
  }
  /// Whether the other side has closed, or does within the time; what it sends before is lost.
  bool ends(std::chrono::milliseconds timeout = std::chrono::seconds(60)) {
    const auto end = std::chrono::steady_clock::now() + timeout;
    while (!has_ended_ && std::chrono::steady_clock::now() < end) {
      pollfd wanted{socket_, POLLIN, 0};
      if (::poll(&wanted, 1, 50) > 0) receive();
    }
    return has_ended_;
  }
  /// One response, with a length or without.
  ClientResponse response(std::chrono::milliseconds timeout = std::chrono::seconds(60)) {
    ClientResponse result;
    size_t end;
    while ((end = buffer_.find("\r\n\r\n")) == std::string::npos)
      if (!more(timeout)) return result;
    const std::string head = buffer_.substr(0, end + 2);
    buffer_.erase(0, end + 4);
    result.status = std::atoi(head.c_str() + head.find(' '));
    for (size_t line = head.find("\r\n") + 2; line < head.size();) {
      const size_t next = head.find("\r\n", line), colon = head.find(':', line);
      std::string name = head.substr(line, colon - line);
      for (char& c : name) c = char(std::tolower(c));
      result.headers[name] = head.substr(colon + 2, next - colon - 2);
      line = next + 2;
    }
    const size_t length = size_t(std::atoll(result.header("content-length").c_str()));
    while (buffer_.size() < length)
      if (!more(timeout)) break;
    result.body = buffer_.substr(0, length);
    buffer_.erase(0, std::min(length, buffer_.size()));
    return result;
  }
  /// Of a stream: all up to a text, "" if it does not come.
  std::string until(const std::string& text,
                    std::chrono::milliseconds timeout = std::chrono::seconds(60)) {
    size_t found;
    while ((found = buffer_.find(text)) == std::string::npos)
      if (!more(timeout)) return {};
    std::string result = buffer_.substr(0, found + text.size());
    buffer_.erase(0, result.size());
    return result;
  }

 private:
  bool more(std::chrono::milliseconds timeout) {
    const std::string bytes = receive(timeout);
    buffer_ += bytes;
    return !bytes.empty();
  }

  int socket_ = -1;
  bool is_connected_ = false, has_ended_ = false;
  std::string buffer_;
};

}  // namespace kaustik::test
