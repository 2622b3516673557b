#pragma once
// What every main does around its work: parse, run, and turn whatever was thrown into one line and
// an exit status: 0 success, 1 failure, 2 bad usage or bad input.

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>

#include "shared/base/error.h"
#include "shared/config/signals.h"

namespace tenon {

/// --help or --version has been answered.
struct CommandLineAnswered {};

/// @throws InputError for bad usage, CommandLineAnswered after --help or --version
inline void parse(CLI::App& app, int argc, char** argv) {
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != 0) throw InputError(std::string(error.what()) + "; see --help");
    static_cast<void>(app.exit(error));
    throw CommandLineAnswered{};
  }
}

/// What was printed has arrived; else said, and no success.
inline int with_output(const char* program, int status) {
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return status;
  std::fprintf(stderr, "%s: standard output could not be written whole\n", program);
  return status == 0 ? 1 : status;
}

/// The exit status of `work()`, or of what it threw.
template <typename Work>
int run_main(const char* program, const Work& work) noexcept {
  try {
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
