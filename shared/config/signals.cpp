#include "shared/config/signals.h"

#include <csignal>

namespace tenon {
namespace {

std::atomic<std::atomic<bool>*> asked{nullptr};
static_assert(std::atomic<bool>::is_always_lock_free);
static_assert(std::atomic<std::atomic<bool>*>::is_always_lock_free);

void ask_to_stop(int /*signal*/) {
  std::atomic<bool>* stop = asked.load(std::memory_order_relaxed);
  if (stop != nullptr) stop->store(true, std::memory_order_relaxed);
}

}  // namespace

void stop_on_signals(std::atomic<bool>& stop) {
  asked.store(&stop, std::memory_order_relaxed);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    const auto before = std::signal(signal, &ask_to_stop);
    if (signal == SIGHUP && before == SIG_IGN) (void)std::signal(signal, SIG_IGN);
  }
}

void survive_full_disks() { (void)std::signal(SIGXFSZ, SIG_IGN); }

}  // namespace tenon
