#pragma once
// A picture of the virtual cell in a browser, as it is now: the truth, for people on this machine.
// look() and what it needs are the simulation's thread's: wait-free, no allocation, no system call.
// Whatever viewers do or do not do happens in threads of this, behind a ring:
//
//   look() ─► ring ─► this view's thread: JSON ─► the newest few ─► libmicrohttpd's: a viewer each
//
// Make it before the simulation's thread takes a real-time priority, which its threads would
// inherit. All else is offline and one thread's.

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <thread>

#include "shared/base/spsc_ring.h"
#include "sim/cell/virtual_arm/truth.h"
#include "sim/cell/virtual_arm/virtual_cell.h"
#include "sim/view/moment_log.h"
#include "sim/view/view_page.h"
#include "sim/view/view_server.h"

namespace tenon::sim {

class LiveView {
 public:
  /// Between two moments, of the cell's time.
  static constexpr std::int64_t kPeriod_ns = 20'000'000;

  /// @param port 0: a free one  @throws InputError where it is not to be had
  LiveView(std::uint16_t port, const ViewedWorld& world);
  LiveView(const LiveView&) = delete;
  LiveView& operator=(const LiveView&) = delete;
  ~LiveView();

  /// "http://127.0.0.1:8080/"
  [[nodiscard]] std::string url() const;

  /// After a step of the cell, which is watched.
  void look(VirtualCell& cell, std::int64_t now_ns) noexcept;

  /// The last picture, and how it ended. Viewers have half a second to take it.
  void end(const Truth& truth);

  /// For people, after end(): who looked on, and what was dropped.
  [[nodiscard]] std::string describe() const;

 private:
  void pass_on();
  void stop();

  static constexpr std::size_t kMoments = 64;
  SpscRing<CellMoment, kMoments> ring_;
  std::int64_t due_ns_ = 0;  ///< the simulation's thread's
  Pose X_BT_;
  MomentLog log_;
  ViewServer server_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace tenon::sim
