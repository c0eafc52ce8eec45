#pragma once
#include <mpi.h>

#include "kaustik/render/team.h"

namespace kaustik::app {

/// All processes that mpirun has started. MPI ends those that wait when one of them fails.
class MpiTeam final : public Team {
 public:
  /// After MPI_Init_thread(), of which one thread at a time makes calls.
  MpiTeam();
  ~MpiTeam() override;
  MpiTeam(const MpiTeam&) = delete;
  MpiTeam& operator=(const MpiTeam&) = delete;

  uint32_t rank() const override { return rank_; }
  uint32_t size() const override { return size_; }
  std::vector<uint8_t> from_leader(std::vector<uint8_t> bytes) override;
  std::vector<std::vector<uint8_t>> to_leader(std::vector<uint8_t> bytes) override;
  /// Along a chain: each adds its own to what comes from the next one, and hands it on towards the
  /// leader, piece by piece. So over each cable the sums go once, however many processes there are.
  void add_up(std::span<Fixed> sums) override;

 private:
  uint32_t rank_ = 0, size_ = 1;
  MPI_Comm all_ = MPI_COMM_NULL;  ///< apart from what others of the program might send
  MPI_Datatype number_ = MPI_DATATYPE_NULL;
};

}  // namespace kaustik::app
