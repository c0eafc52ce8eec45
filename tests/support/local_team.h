#pragma once
// A team whose members are threads.

#include <barrier>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "kaustik/render/team.h"

namespace kaustik::test {

class LocalTeam {
 public:
  explicit LocalTeam(uint32_t size) : size_(size), barrier_(size), given_(size) {}

  /// Calls work(member) in a thread for each of them. What throws there ends the test program: the
  /// others would wait for ever.
  void run(const std::function<void(const std::shared_ptr<Team>&)>& work) {
    std::vector<std::jthread> threads;
    for (uint32_t rank = 0; rank < size_; ++rank)
      threads.emplace_back([&, rank]() noexcept { work(std::make_shared<Member>(*this, rank)); });
  }

 private:
  class Member final : public Team {
   public:
    Member(LocalTeam& team, uint32_t rank) : team_(team), rank_(rank) {}
    uint32_t rank() const override { return rank_; }
    uint32_t size() const override { return team_.size_; }
    std::vector<uint8_t> from_leader(std::vector<uint8_t> bytes) override {
      if (rank_ == 0) team_.given_[0] = std::move(bytes);
      team_.barrier_.arrive_and_wait();
      std::vector<uint8_t> all = team_.given_[0];
      team_.barrier_.arrive_and_wait();
      return all;
    }
    std::vector<std::vector<uint8_t>> to_leader(std::vector<uint8_t> bytes) override {
      team_.given_[rank_] = std::move(bytes);
      team_.barrier_.arrive_and_wait();
      std::vector<std::vector<uint8_t>> all;
      if (rank_ == 0) all = team_.given_;
      team_.barrier_.arrive_and_wait();
      return all;
    }
    void add_up(std::span<Fixed> sums) override {
      if (rank_ == 0) team_.sums_ = sums;
      team_.barrier_.arrive_and_wait();
      if (rank_ > 0) {
        const std::lock_guard lock(team_.mutex_);
        for (size_t i = 0; i < sums.size(); ++i) add_to(team_.sums_[i], sums[i]);
      }
      team_.barrier_.arrive_and_wait();
    }

   private:
    LocalTeam& team_;
    uint32_t rank_;
  };

  uint32_t size_;
  std::barrier<> barrier_;
  std::vector<std::vector<uint8_t>> given_;
  std::mutex mutex_;
  std::span<Fixed> sums_;  ///< the leader's
};

}  // namespace kaustik::test
