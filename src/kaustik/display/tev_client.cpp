#include "kaustik/display/tev_client.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <span>
#include <system_error>
#include <utility>

#include "kaustik/base/error.h"
#include "kaustik/display/tev_packets.h"

namespace kaustik {

struct TevClient::State {
  TevAddress address;
  std::string name;
  TevPatience patience;

  std::mutex mutex;  ///< of what follows
  std::condition_variable changed;
  std::function<void(const std::string&)> warn;  ///< empty once nobody may be told any more
  std::optional<Image> next;
  bool is_busy = false;    ///< sends an image
  bool is_left = false;    ///< the client was destroyed
  bool has_ended = false;  ///< the thread: the viewer was given up, or the client destroyed

  bool left() {
    const std::lock_guard lock(mutex);
    return is_left;
  }
};

namespace {

using SteadyClock = std::chrono::steady_clock;

double seconds_after(SteadyClock::time_point start) {
  return std::chrono::duration<double>(SteadyClock::now() - start).count();
}

std::string reason_text(int code) {
  return std::error_code(code, std::generic_category()).message();
}

/// What ends the client: a sentence's end, such as "connection refused"; empty: it was left.
struct GivenUp {
  std::string why;
};

/// A descriptor of the system, closed with this.
class Socket {
 public:
  Socket() = default;
  explicit Socket(const addrinfo& address)
      : descriptor_(::socket(address.ai_family, address.ai_socktype | SOCK_CLOEXEC | SOCK_NONBLOCK,
                             address.ai_protocol)) {}
  ~Socket() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  Socket(Socket&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
  Socket& operator=(Socket&& other) noexcept {
    std::swap(descriptor_, other.descriptor_);
    return *this;
  }
  int descriptor() const { return descriptor_; }
  /// Whether it can be written to within a moment, so that others may be looked at in between.
  bool is_writable_soon() const {
    pollfd request{descriptor_, POLLOUT, 0};
    return ::poll(&request, 1, 50) > 0;
  }

 private:
  int descriptor_ = -1;
};

struct FreeAddresses {
  void operator()(addrinfo* addresses) const { ::freeaddrinfo(addresses); }
};
using Addresses = std::unique_ptr<addrinfo, FreeAddresses>;

Addresses find_host(const TevAddress& address) {
  addrinfo wanted{};
  wanted.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  const int failed =
      ::getaddrinfo(address.host.c_str(), std::to_string(address.port).c_str(), &wanted, &found);
  if (failed != 0) throw GivenUp{::gai_strerror(failed)};
  return Addresses(found);
}

/// Tries the addresses of the host one after the other; throws GivenUp.
Socket connected(TevClient::State& state) {
  const Addresses addresses = find_host(state.address);
  const auto start = SteadyClock::now();
  int reason = ECONNREFUSED;
  for (const addrinfo* address = addresses.get(); address; address = address->ai_next) {
    Socket socket(*address);
    if (socket.descriptor() < 0) {
      reason = errno;
      continue;
    }
    if (::connect(socket.descriptor(), address->ai_addr, address->ai_addrlen) == 0) return socket;
    reason = errno;
    if (reason != EINPROGRESS) continue;
    while (!socket.is_writable_soon()) {
      if (state.left()) throw GivenUp{};
      if (seconds_after(start) > state.patience.connecting_s) throw GivenUp{reason_text(ETIMEDOUT)};
    }
    socklen_t size = sizeof reason;
    ::getsockopt(socket.descriptor(), SOL_SOCKET, SO_ERROR, &reason, &size);
    if (reason == 0) return socket;
  }
  throw GivenUp{reason_text(reason)};
}

/// Viewers say nothing: what can be read is the end.
void check_is_open(const Socket& socket) {
  char byte = 0;
  if (::recv(socket.descriptor(), &byte, 1, MSG_PEEK | MSG_DONTWAIT) == 0)
    throw GivenUp{"it has closed the connection"};
}

void send_packet(TevClient::State& state, const Socket& socket, std::span<const uint8_t> rest) {
  auto last_taken = SteadyClock::now();
  while (!rest.empty()) {
    if (state.left()) throw GivenUp{};
    const ssize_t count =
        ::send(socket.descriptor(), rest.data(), rest.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    if (count > 0) {
      rest = rest.subspan(size_t(count));
      last_taken = SteadyClock::now();
    } else if (errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR) {
      if (!socket.is_writable_soon() && seconds_after(last_taken) > state.patience.stalled_s)
        throw GivenUp{"it has stopped reading"};
    } else if (errno == EPIPE || errno == ECONNRESET) {
      throw GivenUp{"it has closed the connection"};
    } else {
      throw GivenUp{reason_text(errno)};
    }
  }
}

/// Sends pictures, whose size and channels it has told the viewer before.
class Sender {
 public:
  Sender(TevClient::State& state, Socket socket) : state_(state), socket_(std::move(socket)) {}

  void send(const Image& image) {
    check_is_open(socket_);
    if (width_ != image.width() || height_ != image.height()) create(image);
    // Some megabytes at a time, so that the viewer shows what has come.
    constexpr int most_values = 1 << 18;
    const int width = std::min(image.width(), most_values / 3);
    const int height = std::max(1, most_values / 3 / width);
    for (int y = 0; y < height_; y += height)
      for (int x = 0; x < width_; x += width)
        send_rectangle(image, {x, y, std::min(width, width_ - x), std::min(height, height_ - y)});
  }

 private:
  void create(const Image& image) {
    width_ = image.width();
    height_ = image.height();
    // Some versions would keep one of an earlier render beside it.
    send_packet(state_, socket_, tev::close_image(state_.name));
    send_packet(state_, socket_, tev::create_image(state_.name, true, width_, height_, channels_));
  }
  void send_rectangle(const Image& image, const tev::Rectangle& rectangle) {
    const RgbView rgb = rgb_view(image);
    std::vector<float> values;
    values.reserve(3 * size_t(rectangle.width) * size_t(rectangle.height));
    for (int y = rectangle.y; y < rectangle.y + rectangle.height; ++y)
      for (int x = rectangle.x; x < rectangle.x + rectangle.width; ++x)
        for (const auto& plane : rgb.planes)
          values.push_back(plane[size_t(y) * size_t(width_) + size_t(x)]);
    send_packet(state_, socket_, tev::update_image(state_.name, channels_, rectangle, values));
  }

  TevClient::State& state_;
  Socket socket_;
  const std::vector<std::string> channels_ = {"R", "G", "B"};
  int width_ = 0, height_ = 0;
};

/// The next image to be sent; none: the client was left.
std::optional<Image> next_image(TevClient::State& state) {
  std::unique_lock lock(state.mutex);
  state.is_busy = false;
  state.changed.notify_all();
  state.changed.wait(lock, [&] { return state.is_left || state.next.has_value(); });
  if (state.is_left) return std::nullopt;
  state.is_busy = true;
  return std::exchange(state.next, std::nullopt);
}

void serve(TevClient::State& state) {
  std::string why;
  try {
    Sender sender(state, connected(state));
    while (const std::optional<Image> image = next_image(state)) sender.send(*image);
  } catch (const GivenUp& given_up) {
    why = given_up.why;
  } catch (const std::exception& error) {
    why = error.what();
  }
  const std::lock_guard lock(state.mutex);
  state.has_ended = true;
  state.next.reset();
  if (!why.empty() && state.warn)
    state.warn(fmt::format("no picture in the viewer at {}: {}; the render goes on without it",
                           state.address.text(), why));
  state.changed.notify_all();
}

[[noreturn]] void fail_address(const std::string& text, const Place& place) {
  throw Error(
      ErrorKind::input, fmt::format("cannot read the viewer's address '{}'", text),
      fmt::format("write HOST or HOST:PORT, such as localhost:{}; tev must be running there",
                  TevAddress::usual_port),
      place);
}

}  // namespace

TevAddress TevAddress::parse(const std::string& text, const Place& place) {
  TevAddress address;
  std::string host = text, port;
  if (text.starts_with('[')) {
    const size_t end = text.find(']');
    if (end == std::string::npos) fail_address(text, place);
    host = text.substr(1, end - 1);
    port = text.substr(end + 1);
    if (host.empty() || (!port.empty() && port[0] != ':')) fail_address(text, place);
  } else if (const size_t colon = text.find(':'); colon != std::string::npos) {
    host = text.substr(0, colon);
    port = text.substr(colon);
  }
  if (!host.empty()) address.host = host;
  if (text.empty() || host.find_first_of(" \t/") != std::string::npos) fail_address(text, place);
  if (port.empty()) return address;
  const char *const begin = port.data() + 1, *const end = port.data() + port.size();
  const auto [last, code] = std::from_chars(begin, end, address.port);
  if (code != std::errc{} || last != end || address.port == 0) fail_address(text, place);
  return address;
}

std::string TevAddress::text() const {
  const bool is_ip6 = host.find(':') != std::string::npos;
  return fmt::format("{}{}{}:{}", is_ip6 ? "[" : "", host, is_ip6 ? "]" : "", port);
}

TevClient::TevClient(TevAddress address, std::string name,
                     std::function<void(const std::string&)> warn, const TevPatience& patience)
    : state_(std::make_shared<State>()) {
  state_->address = std::move(address);
  state_->name = std::move(name);
  state_->warn = std::move(warn);
  state_->patience = patience;
  thread_ = std::thread([state = state_] { serve(*state); });
}

TevClient::~TevClient() {
  std::unique_lock lock(state_->mutex);
  state_->is_left = true;
  state_->warn = {};
  state_->next.reset();
  state_->changed.notify_all();
  const bool ended = state_->changed.wait_for(lock, std::chrono::milliseconds(500),
                                              [&] { return state_->has_ended; });
  lock.unlock();
  if (ended)
    thread_.join();
  else
    thread_.detach();
}

void TevClient::show(Image image) {
  const std::lock_guard lock(state_->mutex);
  if (state_->has_ended) return;
  state_->next = std::move(image);
  state_->changed.notify_all();
}

bool TevClient::is_idle() const {
  const std::lock_guard lock(state_->mutex);
  return !state_->is_busy && !state_->next;
}

bool TevClient::is_gone() const {
  const std::lock_guard lock(state_->mutex);
  return state_->has_ended;
}

void TevClient::finish(double most_s) {
  std::unique_lock lock(state_->mutex);
  state_->changed.wait_for(lock, std::chrono::duration<double>(most_s), [&] {
    return state_->has_ended || (!state_->is_busy && !state_->next);
  });
}

}  // namespace kaustik
