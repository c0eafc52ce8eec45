#include "view_options.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "environment_variable.h"
#include "events.h"
#include "kaustik/base/error.h"
#include "kaustik/display/terminal.h"
#include "kaustik/display/tev_client.h"
#include "option_values.h"
#include "screen.h"
#include "terminal_preview.h"

namespace kaustik::app {
namespace {

/// The picture in tev, a few times a second as long as the viewer keeps up.
class TevViewer final : public PictureViewer {
 public:
  TevViewer(const TevAddress& address, const std::string& name) : client_(address, name, warn) {}
  bool is_ready() const override {
    return std::chrono::steady_clock::now() >= next_ && client_.is_idle() && !client_.is_gone();
  }
  void show(const Image& image) override {
    client_.show(image);
    next_ = std::chrono::steady_clock::now() + std::chrono::milliseconds(500);
  }
  void finish() override {
    constexpr double most_s = 5;
    client_.finish(most_s);
  }

 private:
  TevClient client_;
  std::chrono::steady_clock::time_point next_;
};

constexpr const char* by_terminal = "auto";

std::vector<std::string> preview_names() {
  std::vector<std::string> names = terminal_graphics_names();
  names.insert(names.begin(), by_terminal);
  return names;
}

/// Absent: there is nowhere to show a preview, of which it tells.
std::optional<TerminalKind> preview_kind(const std::string& name) {
  if (!screen().is_terminal()) {
    note("no preview: standard error is no terminal");
    return std::nullopt;
  }
  const std::optional<TerminalKind> own = terminal_kind(environment_variable);
  if (name == by_terminal) {
    if (!own) note("no preview: the terminal cannot move its cursor (TERM)");
    return own;
  }
  const std::vector<std::string>& names = terminal_graphics_names();
  const auto index = std::find(names.begin(), names.end(), name) - names.begin();
  return TerminalKind{TerminalGraphics(index), own ? own->full_colour : false};
}

}  // namespace

void add_views(CLI::App& command, ViewOptions& options) {
  takes(command.add_option("--tev", options.tev,
                           "Show the picture in the viewer tev at this address [port 14158]"),
        "HOST:PORT");
  auto* preview =
      command.add_flag("--preview{auto}", options.preview,
                       "Show the picture in the terminal, in a way that it supports, or in the "
                       "given one: --preview=kitty, iterm, sixel, or blocks of characters");
  takes_words(preview, preview_names(), "");
}

void check_views(const ViewOptions& options) {
  if (options.tev) TevAddress::parse(*options.tev, place_in("command line: --tev"));
  if (!options.preview) return;
  const std::vector<std::string> names = preview_names();
  if (std::find(names.begin(), names.end(), *options.preview) == names.end())
    throw Error(ErrorKind::input, "there is no preview '" + *options.preview + "'",
                suggest(*options.preview, names), place_in("command line: --preview"));
}

std::vector<std::unique_ptr<PictureViewer>> make_viewers(
    const ViewOptions& options, const std::string& name,
    const std::shared_ptr<const ToneOperator>& tone) {
  std::vector<std::unique_ptr<PictureViewer>> viewers;
  if (options.tev)
    viewers.push_back(std::make_unique<TevViewer>(TevAddress::parse(*options.tev), name));
  if (!options.preview) return viewers;
  if (events().are_on_screen())
    throw Error(ErrorKind::input, "the preview and lines of JSON would both go to standard error",
                "send the lines elsewhere: --progress-file FILE",
                place_in("command line: --preview"));
  if (const std::optional<TerminalKind> kind = preview_kind(*options.preview))
    viewers.push_back(std::make_unique<TerminalPreview>(*kind, tone));
  return viewers;
}

}  // namespace kaustik::app
