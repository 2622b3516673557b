#pragma once
// How far tenon-evaluate is: one line that is written over, on a terminal alone. Reads the clock of
// the system; one thread at a time.

#include <cstddef>
#include <cstdint>

namespace tenon {

class Progress {
 public:
  /// @param before runs of `all` that are there already
  Progress(std::size_t all, std::size_t before);
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  /// Takes the line away.
  ~Progress();

  void count(bool succeeded);

 private:
  std::size_t all_;
  std::size_t before_;
  std::size_t made_ = 0;
  std::size_t succeeded_ = 0;
  bool terminal_;
  bool shown_ = false;
  std::int64_t begin_ns_;
};

}  // namespace tenon
