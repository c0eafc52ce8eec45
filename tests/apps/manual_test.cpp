// What is made from the tables of options: exit codes, man pages, completions, the version as JSON.

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "tests/apps/program.h"

namespace kaustik::test {
namespace {

class Manual : public ProgramTest {
 protected:
  /// Names of the commands, by --help.
  std::vector<std::string> commands() const {
    const std::string help = run_well({"--help"}).out;
    std::vector<std::string> names;
    const size_t begin = help.find("\nScenes:");
    const std::string list = help.substr(begin, help.find("\nStart with:") - begin);
    const std::regex row("\n  ([a-z]+)  ");
    for (std::sregex_iterator at(list.begin(), list.end(), row), end; at != end; ++at)
      names.push_back((*at)[1]);
    EXPECT_GE(names.size(), 16u);
    return names;
  }
  /// Long options of a command, by --help.
  std::vector<std::string> options(const std::string& command) const {
    const std::string help = run_well({command, "--help"}).out;
    std::vector<std::string> names;
    const std::regex row("\n  (?:-[a-zA-Z],)?(--[a-z-]+)");
    for (std::sregex_iterator at(help.begin(), help.end(), row), end; at != end; ++at)
      names.push_back((*at)[1]);
    EXPECT_FALSE(names.empty()) << command;
    return names;
  }
  /// What a program of the system prints; "" if it is not there.
  static std::string output_of(const std::string& shell_command) {
    std::FILE* pipe = ::popen((shell_command + " 2>&1").c_str(), "r");
    std::string text;
    char buffer[4096];
    while (const size_t count = std::fread(buffer, 1, sizeof buffer, pipe))
      text.append(buffer, count);
    ::pclose(pipe);
    return text;
  }
  static bool is_installed(const std::string& program) {
    return !output_of("command -v " + program).empty();
  }
  /// What bash offers for the last of these words.
  std::string completed(const std::vector<std::string>& words) const {
    write("words", "source completions\nCOMP_WORDS=(" + joined(words) +
                       ")\nCOMP_CWORD=" + std::to_string(words.size() - 1) +
                       "\n_kaustik\nprintf '%s\\n' \"${COMPREPLY[@]}\"\n");
    return output_of("cd '" + path("") + "' && bash --norc words");
  }
  static std::string joined(const std::vector<std::string>& words) {
    std::string text;
    for (const std::string& word : words) text += "'" + word + "' ";
    return text;
  }
};

TEST_F(Manual, ExitCodesAreOneTable) {
  const std::string table = run_well({"help", "exit"}).out;
  EXPECT_TRUE(contains(run_well({"--help"}).out, table));
  std::ifstream file(KAUSTIK_SOURCE_DIR "/docs/reference/cli.md");
  const std::string page{std::istreambuf_iterator<char>(file), {}};
  const std::string manual = run_well({"man"}).out;
  const std::regex row("\n  ([0-9+n]+) +([^\n]+)");
  int count = 0;
  for (std::sregex_iterator at(table.begin(), table.end(), row), end; at != end; ++at, ++count) {
    const std::string code = (*at)[1], meaning = (*at)[2];
    EXPECT_TRUE(contains(page, "| " + code + " | " + meaning + " |")) << code << " " << meaning;
    EXPECT_TRUE(contains(manual, ".B " + code + "\n")) << code;
  }
  EXPECT_EQ(count, 5);
}

TEST_F(Manual, PagesHaveEveryOption) {
  std::filesystem::create_directory(path("man1"));
  run_well({"man", "--folder", "man1"});
  const std::string overview = contents("man1/kaustik.1");
  EXPECT_EQ(overview, run_well({"man"}).out);
  for (const std::string& command : commands()) {
    SCOPED_TRACE(command);
    const std::string page = contents("man1/kaustik-" + command + ".1");
    EXPECT_EQ(page, run_well({"man", command}).out);
    EXPECT_TRUE(contains(overview, ".B " + command + "\n"));
    EXPECT_TRUE(page.starts_with(".TH "));
    for (const std::string& option : options(command)) {
      const std::string escaped = std::regex_replace(option, std::regex("-"), "\\-");
      EXPECT_TRUE(contains(page, "\\fB" + escaped + "\\fR")) << option;
    }
    if (is_installed("groff")) {
      EXPECT_EQ(
          output_of("groff -man -Tutf8 -K utf8 -ww -z '" + path("man1/kaustik-" + command + ".1'")),
          "");
    }
  }
  EXPECT_TRUE(contains(overview, ".SS Pictures\n.TP\n.B tonemap\n")) << overview;
  const RunResult wrong = run({"man", "rendr"});
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_TRUE(contains(wrong.err, "did you mean 'render'")) << wrong.err;
  EXPECT_EQ(run({"man", "--folder", "none"}).exit_code, 2);
}

TEST_F(Manual, CompletionsOfBashComplete) {
  write("completions", run_well({"completion", "bash"}).out);
  EXPECT_EQ(output_of("bash -n '" + path("completions") + "'"), "");
  write("a.xml", "");
  write("b.exr", "");
  write("c.kpt", "");
  std::filesystem::create_directory(path("folder"));
  for (const std::string& command : commands()) {
    EXPECT_TRUE(contains(completed({"kaustik", ""}), command + "\n"));
    const std::string offered = completed({"kaustik", command, "--"});
    for (const std::string& option : options(command))
      EXPECT_TRUE(contains(offered, option + "\n")) << command << " " << option;
  }
  EXPECT_EQ(completed({"kaustik", "rend"}), "render\n");
  EXPECT_EQ(completed({"kaustik", "render", ""}), "folder\na.xml\n");
  EXPECT_EQ(completed({"kaustik", "resume", ""}), "folder\nc.kpt\n");
  EXPECT_EQ(completed({"kaustik", "render", "a.xml", "-o", "b"}), "b.exr\n");
  EXPECT_EQ(completed({"kaustik", "render", "--progress", "j"}), "json\n");
  EXPECT_EQ(completed({"kaustik", "render", "--progress", "=", "j"}), "json\n");
  EXPECT_EQ(completed({"kaustik", "render", "--preview", "=", "s"}), "sixel\n");
  EXPECT_EQ(completed({"kaustik", "render", "--preview", "a"}), "a.xml\n");
  EXPECT_EQ(completed({"kaustik", "render", "--integrator", "photonm"}), "photonmap\n");
  EXPECT_EQ(completed({"kaustik", "render", "--time", ""}), "\n");
  EXPECT_EQ(completed({"kaustik", "help", "rectan"}), "rectangle\n");
  EXPECT_EQ(completed({"kaustik", "completion", "z"}), "zsh\n");
  EXPECT_EQ(completed({"kaustik", "example", "j"}), "jewel\n");
}

TEST_F(Manual, CompletionsOfOtherShellsHaveEveryOption) {
  const std::string zsh = run_well({"completion", "zsh"}).out,
                    fish = run_well({"completion", "fish"}).out;
  for (const std::string& command : commands())
    for (const std::string& option : options(command)) {
      EXPECT_TRUE(contains(zsh, option)) << option;
      EXPECT_TRUE(contains(fish, "__fish_seen_subcommand_from " + command + "'") &&
                  contains(fish, " -l " + option.substr(2) + " "))
          << command << " " << option;
    }
  EXPECT_TRUE(contains(zsh, ":checkpoint:_files -g \"*.kpt\"'")) << zsh;
  EXPECT_TRUE(contains(zsh, ":scene:_files -g \"*.(xml|xml.gz|pbrt|pbrt.gz|gltf|")) << zsh;
  EXPECT_TRUE(contains(zsh, "|rad|rad.gz|rif|rif.gz|vf|vf.gz|oct|oct.gz)\"'")) << zsh;
  write("completions.zsh", zsh);
  write("completions.fish", fish);
  if (is_installed("zsh")) {
    EXPECT_EQ(output_of("zsh -n '" + path("completions.zsh") + "'"), "");
  }
  if (is_installed("fish")) {
    EXPECT_EQ(output_of("fish -n '" + path("completions.fish") + "'"), "");
  }
  const RunResult wrong = run({"completion", "bsh"});
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_TRUE(contains(wrong.err, "bash")) << wrong.err;
}

TEST_F(Manual, TheVersionIsForProgramsToo) {
  const auto facts = nlohmann::json::parse(run_well({"--version", "--json"}).out);
  EXPECT_EQ(facts["version"].get<std::string>() + "\n", run_well({"--version"}).out);
  EXPECT_EQ(facts["name"], "kaustik");
  EXPECT_GE(facts["threads"].get<int>(), 1);
  for (const char* library : {"embree", "TBB", "OpenEXR", "fmt"})
    EXPECT_TRUE(std::regex_match(facts["libraries"][library].get<std::string>(),
                                 std::regex("[0-9]+(\\.[0-9]+)*")))
        << library;
  EXPECT_EQ(run({"--json"}).exit_code, 2);
}

}  // namespace
}  // namespace kaustik::test
