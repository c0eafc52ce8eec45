#pragma once
// For the session's own sources: the passes of a session that has a team.

#include <chrono>

#include "kaustik/render/session_monitor.h"
#include "kaustik/render/team_messages.h"
#include "kaustik/render/team_pace.h"

namespace kaustik {

/// Rounds of passes. In each the leader says which passes are to be rendered, every member renders
/// its own, and all report to the leader. Now and then the films are added up. Rounds end where
/// epochs do, so that all that is learned is known before it is needed; and where the error is
/// looked at. How many passes a round has goes by the clock, what comes out does not.
class Session::TeamRun {
 public:
  TeamRun(Session& session, Monitor& monitor, std::stop_token stop,
          const std::function<void()>& pass_done);
  /// Until the leader says what has ended it.
  SessionEnd run();

 private:
  // All members
  TeamReport rendered(const TeamOrder& order);
  void add_up();

  // The leader
  TeamOrder next_order();
  TeamOrder next_round(uint32_t first);
  /// What ends it before pass `first`, the next one.
  std::optional<SessionEnd> end_before(uint32_t first) const;
  void take_reports(const std::vector<std::vector<uint8_t>>& reports);
  /// Where the error is looked at after these passes, in number of passes.
  static uint32_t next_look(uint32_t passes);
  /// Seconds from one time that films are added up to the next.
  double time_to_add_up() const;
  bool is_time_to_add_up() const;
  /// After passes, when the leader's film has all of them.
  void film_is_whole();
  double next_round_s() const;

  Session& session_;
  Monitor& monitor_;
  std::stop_token stop_;
  const std::function<void()>& pass_done_;
  Team& team_;
  SharedLessons* lessons_;  ///< null: nothing is learned

  // The leader's
  TeamPace pace_;
  PassSet rendered_;                ///< by all, and those that the film began with
  uint32_t elsewhere_ = 0;          ///< of them, that the leader's film has not
  uint32_t lessons_end_ = 0;        ///< passes before it go by what all members know
  double last_s_ = 0, took_s_ = 0;  ///< when films were added up, and how long that took
  double round_begin_s_ = 0;
  bool is_stopped_ = false;  ///< somebody has cancelled
};

}  // namespace kaustik
