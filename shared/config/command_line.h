#pragma once
// What every main does around its work: parse, run, and turn whatever was thrown into one line and
// an exit status: 0 success, 1 failure, 2 bad usage or bad input.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <string>
#include <string_view>
#include <vector>

#include "shared/base/did_you_mean.h"
#include "shared/base/error.h"
#include "shared/config/command_line_texts.h"
#include "shared/config/signals.h"

namespace tenon {

/// --help or --version has been answered.
struct CommandLineAnswered {};

/// "--threads", "-o" of a program, and of its subcommands.
inline std::vector<std::string> option_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  for (const CLI::App* sub : app.get_subcommands(nullptr)) {
    const std::vector<std::string> more = option_names(*sub);
    names.insert(names.end(), more.begin(), more.end());
  }
  return names;
}

/// "check" where --check was meant: taken for the file, so that the file has no place any more.
inline std::string flag_meant(const CLI::App& app) {
  for (const CLI::Option* argument : app.get_options()) {
    if (!argument->get_positional() || argument->count() == 0) continue;
    const std::string word = argument->results().front();
    const std::string flag = "--" + word;
    if (app.get_option_no_throw(flag) == nullptr) continue;
    std::string line = word;
    return line.append(": is no subcommand; did you mean ").append(flag).append("? See --help");
  }
  return {};
}

/// What a word that no argument takes was meant as: a subcommand, or the file of an option.
inline std::string argument_meant(const CLI::App& app, const std::string& word) {
  std::vector<std::string> names;
  for (const CLI::App* sub : app.get_subcommands(nullptr)) names.push_back(sub->get_name());
  const std::vector<std::string_view> known(names.begin(), names.end());
  const std::string meant = did_you_mean(word, known);
  if (!meant.empty()) return ": is no subcommand" + meant + " See --help";
  if (word.ends_with(".tnp") && app.get_option_no_throw("--plan") != nullptr) {
    return ": a plan goes with --plan; see --help";
  }
  if (word.ends_with(".lcmlog") && app.get_option_no_throw("--lcm-url") != nullptr) {
    return ": a log is played by --lcm-url file://" + word + "; see --help";
  }
  return {};
}

/// The line for bad usage. A name that is not known comes before what is missing: who misspells a
/// required option has given it.
inline std::string usage_error(const CLI::App& app, const CLI::ParseError& error) {
  const std::vector<std::string> names = option_names(app);
  const std::vector<std::string_view> known(names.begin(), names.end());
  for (const std::string& word : app.remaining(true)) {
    if (!word.starts_with("--")) {
      const std::string meant = argument_meant(app, word);
      if (!meant.empty()) return word + meant;
      std::string flag = flag_meant(app);
      if (!flag.empty()) return flag;
      continue;
    }
    const std::string name = word.substr(0, word.find('='));
    if (std::find(known.begin(), known.end(), name) != known.end()) {
      return name + ": is an option, but not here: of a subcommand, or of none; see --help";
    }
    const std::string meant = did_you_mean(name, known);
    if (meant.empty()) continue;
    std::string line = word;
    return line.append(": is an unknown option").append(meant).append(" See --help");
  }
  return std::string(error.what()) + "; see --help";
}

/// What an installation is made from, out of the same table as --help.
inline void answer_with_texts(CLI::App& app, int argc, char** argv) {
  const auto alone = [] { throw CLI::ValidationError("--man and --bash-completion stand alone"); };
  app.add_flag_callback("--man", alone, "Print the manual page and exit");
  app.add_flag_callback("--bash-completion", alone,
                        "Print what bash sources to complete this program's command line");
  const std::string path = argv[0];
  const std::string program = path.substr(path.rfind('/') + 1);
  app.name(program);  // of the usage, wherever the program lies
  if (argc != 2) return;
  const std::string_view asked = argv[1];
  if (asked == "--man") {
    std::fputs(manual_page(app, program, app.version()).c_str(), stdout);
  } else if (asked == "--bash-completion") {
    std::fputs(bash_completion(app, program).c_str(), stdout);
  } else {
    return;
  }
  throw CommandLineAnswered{};
}

/// @throws InputError for bad usage, CommandLineAnswered after --help, --version and their like
inline void parse(CLI::App& app, int argc, char** argv) {
  answer_with_texts(app, argc, argv);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != 0) throw InputError(usage_error(app, error));
    static_cast<void>(app.exit(error));
    throw CommandLineAnswered{};
  }
}

/// What was printed has arrived; else said, and no success.
inline int with_output(const char* program, int status) {
  if (output_arrived()) return status;
  std::fprintf(stderr, "%s: %s\n", program, kOutputLost);
  return status == 0 ? 1 : status;
}

/// The exit status of `work()`, or of what it threw.
template <typename Work>
int run_main(const char* program, const Work& work) noexcept {
  try {
    occupy_standard_streams();
    survive_full_disks();
    return with_output(program, work());
  } catch (const CommandLineAnswered&) {
    return 0;
  } catch (const InputError& error) {
    std::fprintf(stderr, "%s: %s\n", program, error.what());
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", program, InputError(error.what()).what());
  } catch (...) {
    std::fprintf(stderr, "%s: stopped by something unknown\n", program);
  }
  return 1;
}

}  // namespace tenon
