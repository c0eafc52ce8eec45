#include "mpi_team.h"

#include <algorithm>
#include <array>
#include <functional>

namespace kaustik::app {
namespace {

constexpr int leader = 0, tag = 1;
/// MPI counts in int.
constexpr size_t most_at_once = size_t{1} << 30;

/// Of the chain that adds up: small, so that all links of it have work soon.
constexpr size_t chain_sums = size_t{16} << 10;

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
}

MpiTeam::~MpiTeam() {
  int is_over = 0;
  MPI_Finalized(&is_over);
  if (is_over) return;
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
  const size_t pieces = (sums.size() + chain_sums - 1) / chain_sums;
  const auto piece = [&](size_t i) {
    return sums.subspan(i * chain_sums, std::min(chain_sums, sums.size() - i * chain_sums));
  };
  // The next piece is under way while one is added.
  std::array<std::vector<Fixed>, 2> arriving;
  std::array<MPI_Request, 2> arrivals{MPI_REQUEST_NULL, MPI_REQUEST_NULL};
  const auto expect = [&](size_t i) {
    if (rank_ + 1 == size_ || i >= pieces) return;
    std::vector<Fixed>& to = arriving[i % 2];
    to.resize(piece(i).size());
    MPI_Irecv(to.data(), int(to.size()), number_, int(rank_) + 1, tag, all_, &arrivals[i % 2]);
  };
  std::vector<MPI_Request> sent;
  expect(0);
  for (size_t i = 0; i < pieces; ++i) {
    expect(i + 1);
    MPI_Wait(&arrivals[i % 2], MPI_STATUS_IGNORE);
    const std::span<Fixed> own = piece(i);
    if (rank_ + 1 < size_)
      for (size_t k = 0; k < own.size(); ++k) add_to(own[k], arriving[i % 2][k]);
    if (is_led_here()) continue;
    MPI_Isend(own.data(), int(own.size()), number_, int(rank_) - 1, tag, all_,
              &sent.emplace_back());
  }
  MPI_Waitall(int(sent.size()), sent.data(), MPI_STATUSES_IGNORE);
}

}  // namespace kaustik::app
