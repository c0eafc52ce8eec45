#pragma once
#include <cstdint>
#include <vector>

namespace kaustik {

/// How fast the members of a team are, as their last passes have told the leader, and how many
/// passes each gets in a round, so that all are done at about the same time.
class TeamPace {
 public:
  explicit TeamPace(uint32_t members) : seconds_(members, 0), passes_(members, 0) {}

  /// A member's passes of a round, and the seconds that they took together; rounds before count
  /// half as much each.
  void add(uint32_t rank, uint32_t passes, double seconds);
  /// Who is too slow for even a pass in a round of so many seconds gets the benefit of the doubt:
  /// it counts as twice as fast, and so is tried again some day.
  void doubt(double seconds);
  /// How many passes each member gets, by rank: `most` together, or fewer, so that each takes about
  /// `seconds`. One each while nobody has been measured; of one pass at least the fastest gets one.
  std::vector<uint32_t> shares(uint64_t most, double seconds) const;
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

  std::vector<double> seconds_, passes_;  ///< by rank
};

}  // namespace kaustik
