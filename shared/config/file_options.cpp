#include "shared/config/file_options.h"

#include <cstdio>
#include <exception>
#include <filesystem>
#include <system_error>

#include "shared/base/error.h"
#include "shared/config/load.h"
#include "shared/config/variant.h"

namespace tenon {
namespace {

namespace fs = std::filesystem;

bool is_file(const FileOption& option) { return !option.file.empty() && option.file != "-"; }

/// Where a link leads, also to a file that is not there yet.
fs::path resolved(const std::string& name) {
  constexpr int kLinksMax = 40;
  std::error_code ignored;
  fs::path file = fs::absolute(config::split_variant(name).file, ignored);
  for (int i = 0; i < kLinksMax && fs::is_symlink(fs::symlink_status(file, ignored)); ++i) {
    file = file.parent_path() / fs::read_symlink(file, ignored);
  }
  fs::path whole = fs::weakly_canonical(file, ignored);
  return whole.empty() ? file : whole;
}

bool same(const FileOption& a, const FileOption& b) {
  if (!is_file(a) || !is_file(b)) return false;
  std::error_code none;  // where one of them does not exist
  return resolved(a.file) == resolved(b.file) || fs::equivalent(a.file, b.file, none);
}

void refuse_same(const FileOption& written, const FileOption& other) {
  if (!same(written, other)) return;
  throw InputError(written.option + " " + written.file + ": is the same file as " + other.option +
                   " " + other.file + "; give each a name of its own");
}

}  // namespace

void check_apart(const std::vector<FileOption>& written, const std::vector<FileOption>& read) {
  for (std::size_t i = 0; i < written.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) refuse_same(written[i], written[j]);
    for (const FileOption& other : read) refuse_same(written[i], other);
  }
}

void FinalFiles::write(const FileOption& file, const std::string& text) {
  if (file.file == "-") std::fputs(text.c_str(), stdout);
  if (!is_file(file)) return;
  try {
    write_file(file.file, text);
  } catch (const std::exception& error) {
    add_loss(file.option + " " + error.what());
  }
}

void FinalFiles::add_loss(const std::string& text) {
  if (text.empty()) return;
  losses_ += (losses_.empty() ? "" : "; ") + text;
}

int FinalFiles::conclude(const char* program, int status) const {
  if (losses_.empty()) return status;
  std::fflush(stdout);
  std::fprintf(stderr, "%s: lost: %s\n", program, losses_.c_str());
  return status == 0 ? 1 : status;
}

}  // namespace tenon
