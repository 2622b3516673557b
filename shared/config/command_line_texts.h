#pragma once
// What a program's option table says to others than its --help: the manual page, and what a shell
// completes. Pure; any thread.

#include <CLI/CLI.hpp>
#include <string>

namespace tenon {

/// A page of section 1 in the language of man(7).
/// @param version as --version prints it
[[nodiscard]] std::string manual_page(const CLI::App& app, const std::string& program,
                                      const std::string& version);

/// A script that bash sources: options, the words that one takes, subcommands, files.
[[nodiscard]] std::string bash_completion(const CLI::App& app, const std::string& program);

}  // namespace tenon
