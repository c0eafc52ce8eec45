#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <thread>

#include "commands.h"
#include "environment_variable.h"
#include "file_roles.h"
#include "kaustik/integrator/foreign_integrators.h"
#include "kaustik/integrator/registry.h"
#include "kaustik/view/view_server.h"
#include "numbers.h"
#include "option_values.h"
#include "page_opener.h"
#include "render_job.h"
#include "scene_options.h"
#include "screen.h"
#include "signals.h"
#include "standard_streams.h"
#include "texture_memory.h"
#include "thesis_settings.h"
#include "thread_choice.h"

namespace kaustik::app {
namespace {

/// Tried first, so that the address stays the same; any that is free if it is taken.
constexpr uint16_t usual_port = 8763;
constexpr const char* token_variable = "KAUSTIK_VIEW_TOKEN";
constexpr size_t shortest_token = 16;
/// Few: who moves the camera waits for the first pass at rest.
constexpr uint32_t samples_per_pass = 4;

struct ViewerOptions {
  RenderRecipe recipe;
  std::vector<std::string> definitions, settings;
  std::optional<uint32_t> port;
  std::string address = "127.0.0.1", output = ".";
  bool no_browser = false;
  BuildOptions build;
  int threads = 0;
};

/// Of who wants the same address again after the program was started anew; "": a random one.
std::string token_of_environment() {
  const std::string token = environment_variable(token_variable);
  const bool is_plain = std::all_of(token.begin(), token.end(), [](unsigned char c) {
    return std::isalnum(c) || c == '-' || c == '_';
  });
  if (!token.empty() && (token.size() < shortest_token || !is_plain))
    throw Error(ErrorKind::input,
                fmt::format("{} is no token that strangers cannot guess", token_variable),
                fmt::format("give it at least {} letters and digits, at random", shortest_token));
  return token;
}

void check_output_folder(const std::string& folder) {
  std::error_code error;
  if (!std::filesystem::is_directory(folder, error))
    throw Error(ErrorKind::input, fmt::format("'{}' is no folder", folder),
                "give one that is there: --output FOLDER");
}

/// A view that moves does without it, so that only the view at rest would find out.
void check_method(const std::string& name) {
  const Object asked{"integrator", name, "", {}, {}, {}};
  if (!name.empty() && !find_integrator_type(native_type(asked)))
    throw Error(ErrorKind::input, fmt::format("there is no integrator '{}'", name),
                suggest(name, integrator_names()), place_in(integrator_origin));
}

std::unique_ptr<view::ViewServer> started(const Description& description,
                                          view::ViewSettings settings,
                                          const std::optional<uint32_t>& port) {
  settings.port = uint16_t(port.value_or(usual_port));
  try {
    return std::make_unique<view::ViewServer>(copy_of(description), settings, terminal_messages());
  } catch (const Error& error) {
    if (port || error.kind() != ErrorKind::system) throw;
  }
  settings.port = 0;
  return std::make_unique<view::ViewServer>(copy_of(description), settings, terminal_messages());
}

void tell_how_to_reach(const view::ViewServer& server, const ViewerOptions& options) {
  fmt::print("{}\n", server.url());
  std::fflush(stdout);
  if (!server.is_local())
    warn(
        fmt::format("{} is open to other machines, and what is sent can be read on the way: who "
                    "has the token can render here and save pictures. From another machine "
                    "rather use: ssh -L {}:127.0.0.1:{} THIS_MACHINE",
                    options.address, server.port(), server.port()));
  say("open this address in a browser (from another machine first: ssh -L {0}:127.0.0.1:{0} "
      "THIS_MACHINE); Ctrl-C ends it",
      server.port());
}

/// Until a signal comes. Throws what is wrong with the scene, if it never was rendered.
void serve(const view::ViewServer& server, const InterruptGuard& interrupt) {
  while (!interrupt.token().stop_requested()) {
    const EngineStatus status = server.engine().status();
    if (status.refusal && status.revision == 0) std::rethrow_exception(status.refusal);
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
}

void view_scene(ViewerOptions options) {
  RenderRecipe& recipe = options.recipe;
  FileRoles roles;
  roles.reads_scene(recipe.scene);
  check_output_folder(options.output);
  check_method(recipe.integrator);
  recipe.folder = std::filesystem::current_path().string();
  recipe.definitions = parse_definitions(options.definitions);
  const Description description = load_description(recipe);
  recipe.settings = collected_settings(integrator_of(description, recipe), {}, options.settings);
  view::ViewSettings settings;
  settings.scene = is_standard_stream(recipe.scene)
                       ? "scene"
                       : std::filesystem::path(recipe.scene).stem().string();
  settings.engine.recipe = recipe;
  settings.engine.build = options.build;
  settings.engine.session.threads = usable_threads(options.threads, false);
  settings.engine.session.is_endless = true;
  settings.engine.session.samples_per_pass = samples_per_pass;
  settings.address = options.address;
  settings.token = token_of_environment();
  settings.output_folder = options.output;
  const InterruptGuard interrupt;
  const auto server = started(description, settings, options.port);
  tell_how_to_reach(*server, options);
  PageOpener opener;
  if (!options.no_browser && PageOpener::is_of_use() && !opener.open(server->url()))
    note("no browser could be started by xdg-open");
  serve(*server, interrupt);
  say("ended");
}

}  // namespace

void add_view(CLI::App& program) {
  CLI::App* command = program.add_subcommand(
      "view", "Show a scene in a browser while it renders, and change its camera and parameters.");
  command->footer(
      "It prints an address, and opens it if there is a desktop. The address contains a token; "
      "keep it secret. While the camera moves, photons are kept, so caustics stay. At rest the "
      "scene's own integrator takes over.\n"
      "Only this machine can reach the address. From another machine, connect by ssh, then open "
      "the same address there:\n"
      "  ssh -L 8763:127.0.0.1:8763 MACHINE\n"
      "The environment variable KAUSTIK_VIEW_TOKEN sets the token, so open pages find the program "
      "after a restart.");
  auto options = std::make_shared<ViewerOptions>();
  add_scene(*command, options->recipe.scene);
  command->add_option("--port", options->port, "Port to listen on [8763, or any free one]")
      ->check(whole_number(1, 65535));
  takes(command->add_option(
            "--listen", options->address,
            "Address to listen on; any but 127.0.0.1 and ::1 admits other machines [127.0.0.1]"),
        "ADDRESS");
  command->add_flag("--no-browser", options->no_browser,
                    "Start no browser; only print the address");
  takes(command->add_option("--output", options->output,
                            "Folder in which pages may save pictures under new names [.]"),
        "FOLDER");
  add_definitions(*command, options->definitions);
  add_strict(*command, options->recipe.is_strict);
  add_camera(*command, options->recipe.camera);
  add_settings(*command, options->settings, "film.width=640, integrator.max_depth=8, ID.radius=2");
  takes_words(
      command->add_option("--integrator", options->recipe.integrator,
                          "Use this method instead of the file's while the camera is at rest"),
      integrator_names(), "METHOD");
  add_texture_memory(*command, options->build);
  add_threads(*command, options->threads);
  command->callback([options] { view_scene(*options); });
}

}  // namespace kaustik::app
