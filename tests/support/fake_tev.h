#pragma once
// A viewer that listens as tev does, and decodes packets by itself, from their description in tev's
// include/tev/Ipc.h.

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <bit>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace kaustik::test {

/// A picture as the viewer holds it: by channel, row by row.
struct ViewedPicture {
  int width = 0, height = 0;
  std::map<std::string, std::vector<float>> channels;
};

/// Reads the fields of a packet; throws std::runtime_error where it ends before.
class PacketFields {
 public:
  explicit PacketFields(std::vector<uint8_t> bytes) : bytes_(std::move(bytes)) {}
  uint64_t number(size_t size) {
    if (at_ + size > bytes_.size()) throw std::runtime_error("the packet ends within a number");
    uint64_t value = 0;
    for (size_t i = 0; i < size; ++i) value |= uint64_t(bytes_[at_ + i]) << (8 * i);
    at_ += size;
    return value;
  }
  int32_t integer() { return int32_t(uint32_t(number(4))); }
  float real() { return std::bit_cast<float>(uint32_t(number(4))); }
  std::string text() {
    std::string result;
    while (const uint64_t c = number(1)) result += char(c);
    return result;
  }
  size_t rest() const { return bytes_.size() - at_; }

 private:
  std::vector<uint8_t> bytes_;
  size_t at_ = 0;
};

enum class ViewerManner {
  reads,         ///< all that comes
  never_reads,   ///< accepts, and leaves everything in the pipe
  closes_early,  ///< after the first picture was made
};

class FakeTev {
 public:
  explicit FakeTev(ViewerManner manner = ViewerManner::reads) : manner_(manner) {
    listener_ = ::socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    if (listener_ < 0 || ::bind(listener_, reinterpret_cast<sockaddr*>(&address), size) != 0 ||
        ::listen(listener_, 1) != 0 ||
        ::getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size) != 0)
      throw std::runtime_error("cannot listen");
    port_ = ntohs(address.sin_port);
    thread_ = std::thread([this] { serve(); });
  }
  ~FakeTev() {
    is_stopped_ = true;
    thread_.join();
    if (listener_ >= 0) ::close(listener_);
  }
  FakeTev(const FakeTev&) = delete;
  FakeTev& operator=(const FakeTev&) = delete;

  uint16_t port() const { return port_; }
  bool is_connected() const { return is_connected_; }
  /// By name.
  std::map<std::string, ViewedPicture> pictures() const {
    const std::lock_guard lock(mutex_);
    return pictures_;
  }
  /// Types of the packets, in their order.
  std::vector<int> types() const {
    const std::lock_guard lock(mutex_);
    return types_;
  }
  /// What was wrong with a packet; "": nothing.
  std::string complaint() const {
    const std::lock_guard lock(mutex_);
    return complaint_;
  }

 private:
  static bool is_ready(int descriptor) {
    pollfd request{descriptor, POLLIN, 0};
    return ::poll(&request, 1, 20) > 0;
  }
  void serve() {
    while (!is_ready(listener_))
      if (is_stopped_) return;
    const int connection = ::accept(listener_, nullptr, nullptr);
    is_connected_ = true;
    try {
      std::vector<uint8_t> bytes;
      while (!is_stopped_) {
        if (manner_ == ViewerManner::never_reads) {
          std::this_thread::sleep_for(std::chrono::milliseconds(5));
          continue;
        }
        if (manner_ == ViewerManner::closes_early && !pictures().empty()) break;
        if (!is_ready(connection)) continue;
        uint8_t buffer[1 << 16];
        const ssize_t count = ::recv(connection, buffer, sizeof buffer, 0);
        if (count <= 0) break;
        bytes.insert(bytes.end(), buffer, buffer + count);
        take_packets(bytes);
      }
    } catch (const std::exception& error) {
      const std::lock_guard lock(mutex_);
      complaint_ = error.what();
    }
    ::close(connection);
  }
  void take_packets(std::vector<uint8_t>& bytes) {
    while (bytes.size() >= 4) {
      const size_t length =
          bytes[0] | size_t(bytes[1]) << 8 | size_t(bytes[2]) << 16 | size_t(bytes[3]) << 24;
      if (length < 5) throw std::runtime_error("a packet is too short");
      if (bytes.size() < length) return;
      take(PacketFields({bytes.begin() + 4, bytes.begin() + std::ptrdiff_t(length)}));
      bytes.erase(bytes.begin(), bytes.begin() + std::ptrdiff_t(length));
    }
  }
  void take(PacketFields packet) {
    const std::lock_guard lock(mutex_);
    const int type = int(packet.number(1));
    types_.push_back(type);
    if (type == 2) {  // CloseImage
      pictures_.erase(packet.text());
    } else if (type == 4) {  // CreateImage
      packet.number(1);
      ViewedPicture& picture = pictures_[packet.text()];
      picture.width = packet.integer();
      picture.height = packet.integer();
      const int count = packet.integer();
      for (int i = 0; i < count; ++i)
        picture.channels[packet.text()].assign(size_t(picture.width) * size_t(picture.height), 0);
    } else if (type == 6) {  // UpdateImageV3
      update(packet);
    } else {
      throw std::runtime_error("a packet of type " + std::to_string(type));
    }
    if (type != 6 && packet.rest() != 0) throw std::runtime_error("a packet has a tail");
  }
  void update(PacketFields& packet) {
    packet.number(1);
    ViewedPicture& picture = pictures_.at(packet.text());
    const auto count = size_t(packet.integer());
    std::vector<std::string> names;
    for (size_t i = 0; i < count; ++i) names.push_back(packet.text());
    const int x = packet.integer(), y = packet.integer();
    const int width = packet.integer(), height = packet.integer();
    std::vector<int64_t> begins, steps;
    for (size_t i = 0; i < count; ++i) begins.push_back(int64_t(packet.number(8)));
    for (size_t i = 0; i < count; ++i) steps.push_back(int64_t(packet.number(8)));
    std::vector<float> values;
    while (packet.rest() >= 4) values.push_back(packet.real());
    for (size_t c = 0; c < count; ++c)
      for (int i = 0; i < width * height; ++i)
        picture.channels.at(names[c]).at(size_t(y + i / width) * size_t(picture.width) +
                                         size_t(x + i % width)) =
            values.at(size_t(begins[c] + i * steps[c]));
  }

  const ViewerManner manner_;
  int listener_ = -1;
  uint16_t port_ = 0;
  std::atomic<bool> is_stopped_{false}, is_connected_{false};
  mutable std::mutex mutex_;
  std::map<std::string, ViewedPicture> pictures_;
  std::vector<int> types_;
  std::string complaint_;
  std::thread thread_;
};

}  // namespace kaustik::test
