#pragma once
#include <cstdint>
#include <vector>

namespace kaustik {

/// What a round of passes is to take about. Members wait for one another at its end.
inline constexpr double shortest_round_s = 5, longest_round_s = 300;
/// Of the time until a team's films are added up: a round of what is left would be short.
inline constexpr double soon_enough = 0.875;

/// How fast the members of a team are, as their last passes have told the leader, and how many
/// passes each gets in a round, so that all are done at about the same time.
class TeamPace {
 public:
  explicit TeamPace(uint32_t members)
      : seconds_(members, 0),
        passes_(members, 0),
        idle_s_(members, 0),
        has_worked_(members, false) {}

  /// A member's passes of a round, and the seconds that they took together; rounds before count
  /// half as much each, unless it was idle since.
  void add(uint32_t rank, uint32_t passes, double seconds);
  /// A round has taken so many seconds: who had no pass in it was idle.
  void round_done(double seconds);
  /// How many passes each member gets, by rank: `most` together, or fewer, so that each takes about
  /// `seconds`. One each while nobody has been measured; of one pass at least the fastest gets one.
  /// Who is too slow for a pass gets one now and then, as it may have become faster: so rarely that
  /// waiting for it takes little of the time, and only if it would be done within `longest_s`.
  std::vector<uint32_t> shares(uint64_t most, double seconds, double longest_s) const;
  /// What a pass takes the one in the middle, s; 0: not known.
  double usual_pass_s() const;
  /// The same of the fastest.
  double fastest_pass_s() const;
  /// Seconds for the next round, of at least so many: of twice as many passes as the round before,
  /// so that little time is lost while nobody knows who is slow, and little at the ends of rounds
  /// when all is known.
  double next_round_s(double least, double most) const;

 private:
  /// By rank; 0: not known.
  std::vector<double> pass_s() const;
  /// Of those that are known.
  std::vector<double> known() const;
  void try_again(std::vector<uint32_t>& shares, uint64_t most, double longest_s) const;

  // By rank
  std::vector<double> seconds_, passes_;
  std::vector<double> idle_s_;    ///< since its last pass
  std::vector<bool> has_worked_;  ///< in this round
};

}  // namespace kaustik
