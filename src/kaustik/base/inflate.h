#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

struct z_stream_s;

namespace kaustik {

/// How a stream of zlib's is wrapped.
enum class Packing { gzip, zlib };

/// Unpacks a stream piece by piece.
class Inflater {
 public:
  /// Of bytes that must outlive it.
  Inflater(std::span<const uint8_t> bytes, Packing packing);
  /// Of pieces that are asked for one by one; an empty one is the end.
  using NextPiece = std::function<std::vector<uint8_t>()>;
  Inflater(NextPiece next_piece, Packing packing);
  ~Inflater();
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;

  /// Appends to `out` until it has `most` bytes, all is read, or something is wrong.
  void unpack(std::vector<uint8_t>& out, size_t most);
  /// Fills `out` as far as that goes; returns how many bytes it has.
  size_t fill(std::span<uint8_t> out);
  /// Whether all has been read: gzip may have several members, one after the other; what follows a
  /// stream of zlib's is not looked at.
  bool is_whole() const;
  bool is_damaged() const { return is_damaged_; }

 private:
  void feed();

  std::unique_ptr<z_stream_s> stream_;
  NextPiece next_piece_;  ///< may be empty
  std::vector<uint8_t> piece_;
  std::span<const uint8_t> left_;
  Packing packing_;
  bool at_end_ = false, is_damaged_ = false;
};

}  // namespace kaustik
