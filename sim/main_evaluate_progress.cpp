#include "sim/main_evaluate_progress.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <string>

#include "shared/system/monotonic_clock.h"

namespace tenon {

Progress::Progress(std::size_t all, std::size_t before)
    : all_(all),
      before_(before),
      terminal_(::isatty(STDERR_FILENO) == 1),
      begin_ns_(monotonic_now_ns()) {}

Progress::~Progress() {
  if (shown_) std::fputs("\r\033[K", stderr);
}

void Progress::count(bool succeeded) {
  ++made_;
  succeeded_ += succeeded;
  if (!terminal_) return;
  const double elapsed_s = 1e-9 * static_cast<double>(monotonic_now_ns() - begin_ns_);
  const double rate_ps = static_cast<double>(made_) / std::max(elapsed_s, 1e-3);
  const std::size_t so_far = before_ + made_;
  constexpr std::size_t kWidth = 30;
  const std::string bar(kWidth * so_far / all_, '#');
  std::fprintf(
      stderr, "\r\033[K[%-30s] %zu of %zu runs, %.1f %% succeeded, %.2f runs/s, %.0f s left",
      bar.c_str(), so_far, all_, 1e2 * static_cast<double>(succeeded_) / static_cast<double>(made_),
      rate_ps, static_cast<double>(all_ - so_far) / rate_ps);
  shown_ = true;
}

}  // namespace tenon
