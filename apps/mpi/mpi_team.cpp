#include "mpi_team.h"

#include <algorithm>
#include <cstring>
#include <functional>

namespace kaustik::app {
namespace {

constexpr int leader = 0, tag = 1;
/// MPI counts in int.
constexpr size_t most_at_once = size_t{1} << 30;

/// Of two rows of sums, which MPI may have put anywhere.
void add_sums(void* in, void* sums, int* count, MPI_Datatype*) {
  const auto* from = static_cast<const uint8_t*>(in);
  auto* to = static_cast<uint8_t*>(sums);
  for (int i = 0; i < *count; ++i, from += sizeof(Fixed), to += sizeof(Fixed)) {
    Fixed value, sum;
    std::memcpy(&value, from, sizeof value);
    std::memcpy(&sum, to, sizeof sum);
    add_to(sum, value);
    std::memcpy(to, &sum, sizeof sum);
  }
}

/// Calls move(bytes, count) for pieces that MPI can count.
void in_pieces(std::vector<uint8_t>& bytes, const std::function<void(uint8_t*, int)>& move) {
  for (size_t at = 0; at < bytes.size(); at += most_at_once)
    move(bytes.data() + at, int(std::min(most_at_once, bytes.size() - at)));
}

}  // namespace

MpiTeam::MpiTeam() {
  MPI_Comm_dup(MPI_COMM_WORLD, &all_);
  int number = 0;
  MPI_Comm_rank(all_, &number);
  rank_ = uint32_t(number);
  MPI_Comm_size(all_, &number);
  size_ = uint32_t(number);
  MPI_Type_contiguous(sizeof(Fixed), MPI_BYTE, &number_);
  MPI_Type_commit(&number_);
  constexpr int commutes = 1;
  MPI_Op_create(add_sums, commutes, &addition_);
}

MpiTeam::~MpiTeam() {
  int is_over = 0;
  MPI_Finalized(&is_over);
  if (is_over) return;
  MPI_Op_free(&addition_);
  MPI_Type_free(&number_);
  MPI_Comm_free(&all_);
}

std::vector<uint8_t> MpiTeam::from_leader(std::vector<uint8_t> bytes) {
  uint64_t size = bytes.size();
  MPI_Bcast(&size, 1, MPI_UINT64_T, leader, all_);
  bytes.resize(size);
  in_pieces(bytes,
            [&](uint8_t* piece, int count) { MPI_Bcast(piece, count, MPI_BYTE, leader, all_); });
  return bytes;
}

std::vector<std::vector<uint8_t>> MpiTeam::to_leader(std::vector<uint8_t> bytes) {
  const uint64_t size = bytes.size();
  std::vector<uint64_t> sizes(is_led_here() ? size_ : 0);
  MPI_Gather(&size, 1, MPI_UINT64_T, sizes.data(), 1, MPI_UINT64_T, leader, all_);
  if (!is_led_here()) {
    in_pieces(bytes, [&](uint8_t* piece, int count) {
      MPI_Send(piece, count, MPI_BYTE, leader, tag, all_);
    });
    return {};
  }
  std::vector<std::vector<uint8_t>> all(size_);
  all[0] = std::move(bytes);
  for (uint32_t from = 1; from < size_; ++from) {
    all[from].resize(sizes[from]);
    in_pieces(all[from], [&](uint8_t* piece, int count) {
      MPI_Recv(piece, count, MPI_BYTE, int(from), tag, all_, MPI_STATUS_IGNORE);
    });
  }
  return all;
}

void MpiTeam::add_up(std::span<Fixed> sums) {
  if (size_ == 1) return;
  // Each adds up a share, the last of which may end in zeros.
  const size_t share = (sums.size() + size_ - 1) / size_;
  std::vector<Fixed> all(share * size_), own(share);
  std::copy(sums.begin(), sums.end(), all.begin());
  MPI_Reduce_scatter_block(all.data(), own.data(), int(share), number_, addition_, all_);
  MPI_Gather(own.data(), int(share), number_, all.data(), int(share), number_, leader, all_);
  if (is_led_here()) std::copy_n(all.begin(), sums.size(), sums.begin());
}

}  // namespace kaustik::app
