#pragma once
// What may stand for an option's value: told once, where the option is declared, and shown by
// --help, man pages and the completions of shells.

#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <vector>

namespace kaustik::app {

struct OptionValues {
  enum class Kind {
    other,  ///< nothing that can be listed
    files,
    words
  };
  Kind kind = Kind::other;
  /// The words; of files their extensions without the dot, none: any file.
  std::vector<std::string> names;
};

/// The value is a file; --help calls it so.
CLI::Option* takes_files(CLI::Option* option, const std::vector<std::string>& extensions);
/// The value is one of `words` (it is not checked here); --help lists them.
CLI::Option* takes_words(CLI::Option* option, const std::vector<std::string>& words);
/// The same of more words than a line holds, which --help calls `name`.
CLI::Option* takes_words(CLI::Option* option, const std::vector<std::string>& words,
                         const std::string& name);
/// The same of words that it takes a while to find: they are asked for where they are shown.
CLI::Option* takes_words_of(CLI::Option* option, std::function<std::vector<std::string>()> words,
                            const std::string& name);
/// Other values are called `name`.
CLI::Option* takes(CLI::Option* option, const std::string& name);

/// What was told of the option.
OptionValues values_of(const CLI::Option* option);

// Extensions of files that several commands take.
const std::vector<std::string>& scene_extensions();
const std::vector<std::string>& picture_extensions();   ///< that can be read
const std::vector<std::string>& written_extensions();   ///< of pictures with light in them
const std::vector<std::string>& rendered_extensions();  ///< of those, and tables of meters
const std::vector<std::string>& shown_extensions();     ///< of pictures for displays

}  // namespace kaustik::app
