#pragma once
#include <set>
#include <string>

#include "kaustik/render/team.h"

namespace kaustik::app {

/// Files from the leader of a team to members that may not see them. A member gets copies in a
/// temporary folder of its own, and works there: names that are relative to the leader's working
/// folder lead to the copies. The folder ends with this.
class FileBroadcast {
 public:
  /// All members make one at the same time. `files`: the leader's; what others give is not looked
  /// at. Throws Error(input) for a file that cannot be read, Error(system) where copies cannot be
  /// written.
  FileBroadcast(Team& team, const std::set<std::string>& files);
  ~FileBroadcast();
  FileBroadcast(const FileBroadcast&) = delete;
  FileBroadcast& operator=(const FileBroadcast&) = delete;

  /// What a name of the command line is called here: a whole path leads to the copy, too.
  std::string here(const std::string& path) const;

 private:
  void send(Team& team, const std::set<std::string>& files) const;
  void receive(Team& team);

  std::string folder_;  ///< "": the leader's files themselves
};

}  // namespace kaustik::app
