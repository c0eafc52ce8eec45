#include "kaustik/render/team_pace.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace kaustik {
namespace {

/// A clock may show no time at all.
constexpr double shortest_s = 1e-6;
/// Share of the time that may go into waiting for those that are tried again.
constexpr double most_waiting = 0.05;
/// More than anybody waits for.
constexpr double most_passes = 1e6;

/// Passes that each finishes in about so many seconds, the nearest number of them.
std::vector<uint32_t> finished_within(double seconds, const std::vector<double>& pass_s) {
  std::vector<uint32_t> passes(pass_s.size());
  for (size_t rank = 0; rank < pass_s.size(); ++rank)
    passes[rank] = uint32_t(std::clamp(std::round(seconds / pass_s[rank]), 0.0, most_passes));
  return passes;
}

uint64_t sum(const std::vector<uint32_t>& passes) {
  return std::accumulate(passes.begin(), passes.end(), uint64_t{0});
}

/// As many passes as there are, by bisection of the seconds that they take.
std::vector<uint32_t> shares_of(uint64_t passes, double seconds,
                                const std::vector<double>& pass_s) {
  double least_s = 0;
  for (int step = 0; step < 60; ++step) {
    const double middle_s = 0.5 * (least_s + seconds);
    (sum(finished_within(middle_s, pass_s)) <= passes ? least_s : seconds) = middle_s;
  }
  std::vector<uint32_t> shares = finished_within(least_s, pass_s);
  // Who are equally fast come to their next pass at the same moment, which is too much for some.
  std::vector<size_t> soonest(pass_s.size());
  std::iota(soonest.begin(), soonest.end(), size_t{0});
  std::ranges::stable_sort(soonest, {},
                           [&](size_t rank) { return (shares[rank] + 1) * pass_s[rank]; });
  const uint64_t left = passes - sum(shares);
  for (uint64_t i = 0; i < left; ++i) ++shares[soonest[i % soonest.size()]];
  return shares;
}

}  // namespace

void TeamPace::add(uint32_t rank, uint32_t passes, double seconds) {
  if (passes == 0) return;
  // What was before it was idle is old.
  const double kept = idle_s_[rank] > 0 ? 0 : 0.5;
  seconds_[rank] = kept * seconds_[rank] + seconds;
  passes_[rank] = kept * passes_[rank] + passes;
  has_worked_[rank] = true;
}

void TeamPace::round_done(double seconds) {
  for (double& idle_s : idle_s_) idle_s += seconds;
  for (size_t rank = 0; rank < idle_s_.size(); ++rank)
    if (has_worked_[rank]) idle_s_[rank] = 0;
  has_worked_.assign(has_worked_.size(), false);
}

std::vector<double> TeamPace::pass_s() const {
  std::vector<double> each(seconds_.size(), 0);
  for (size_t rank = 0; rank < each.size(); ++rank)
    if (passes_[rank] > 0) each[rank] = std::max(seconds_[rank] / passes_[rank], shortest_s);
  return each;
}

std::vector<double> TeamPace::known() const {
  std::vector<double> known = pass_s();
  std::erase(known, 0);
  return known;
}

double TeamPace::next_round_s(double least, double most) const {
  const double usual_s = usual_pass_s();
  std::vector<double> passes = passes_;
  std::ranges::nth_element(passes, passes.begin() + std::ptrdiff_t(passes.size() / 2));
  // What is kept of rounds is up to twice the last one.
  return std::clamp(std::ceil(1.5 * passes[passes.size() / 2]) * usual_s, least, most);
}

double TeamPace::usual_pass_s() const {
  std::vector<double> all = known();
  if (all.empty()) return 0;
  const auto middle = all.begin() + std::ptrdiff_t(all.size() / 2);
  std::ranges::nth_element(all, middle);
  return *middle;
}

double TeamPace::fastest_pass_s() const {
  const std::vector<double> all = known();
  return all.empty() ? 0 : *std::ranges::min_element(all);
}

std::vector<uint32_t> TeamPace::shares(uint64_t most, double seconds, double longest_s) const {
  const double usual_s = usual_pass_s();
  std::vector<double> pass_s = this->pass_s();
  std::ranges::replace(pass_s, 0.0, usual_s > 0 ? usual_s : 1.0);
  std::vector<uint32_t> shares = finished_within(usual_s > 0 ? seconds : 1, pass_s);
  const uint64_t wanted = std::clamp<uint64_t>(sum(shares), 1, most);
  // Nobody is done with more than that many by then.
  if (sum(shares) != wanted)
    shares = shares_of(
        wanted, double(wanted + 1) * std::max(seconds, *std::ranges::max_element(pass_s)), pass_s);
  try_again(shares, most, longest_s);
  return shares;
}

void TeamPace::try_again(std::vector<uint32_t>& shares, uint64_t most, double longest_s) const {
  const std::vector<double> pass_s = this->pass_s();
  for (size_t rank = 0; rank < shares.size(); ++rank) {
    if (shares[rank] > 0 || pass_s[rank] > longest_s) continue;
    if (most_waiting * idle_s_[rank] < pass_s[rank] || idle_s_[rank] == 0) continue;
    if (sum(shares) == most) --*std::ranges::max_element(shares);
    ++shares[rank];
  }
}

}  // namespace kaustik
