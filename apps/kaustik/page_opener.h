#pragma once
#include <string>

namespace kaustik::app {

/// Opens an address in the user's browser, if there is a desktop and a person at the terminal. The
/// browser is started with a file that leads there and that this user alone can read: what programs
/// are started with all users of the machine can see.
class PageOpener {
 public:
  PageOpener() = default;
  /// Takes the file away.
  ~PageOpener();
  PageOpener(const PageOpener&) = delete;
  PageOpener& operator=(const PageOpener&) = delete;

  /// Whether there is somebody to open it for.
  static bool is_of_use();
  /// False: it could not be opened.
  bool open(const std::string& url);

 private:
  std::string folder_;
};

}  // namespace kaustik::app
