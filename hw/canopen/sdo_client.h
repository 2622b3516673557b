#pragma once
// One SDO transfer at a time, expedited or segmented (CiA 301, 7.2.4). No I/O, no clock: each call
// returns the frame that has to leave, if any. No allocation; one thread; owns its memory. Frames
// of the wrong length, node or object are ignored, because a late answer is not the one asked for.
//
//   kIdle --start--> kBusy --last answer--> kDone
//                      |---- abort -------> kAborted   (from the node, or by this side: abort_code)
//                      +---- silence -----> kTimedOut
//
// However a node answers, a transfer has an end: an empty segment that is not the last is an abort
// of this side, and one that goes on for kTimeoutsMost timeouts counts as silence.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "hw/canopen/sdo.h"
#include "shared/ports/can_bus.h"

namespace tenon::hw::canopen {

class SdoClient {
 public:
  static constexpr std::size_t kMaxBytes = 1024;
  static constexpr std::int64_t kTimeoutsMost = 10;  ///< for a whole transfer
  enum class State : std::uint8_t { kIdle, kBusy, kDone, kAborted, kTimedOut };

  /// @param timeout_ns for each answer; see kTimeoutsMost
  explicit SdoClient(std::int64_t timeout_ns = 500'000'000) : timeout_ns_(timeout_ns) {}

  /// Reads an object. Replaces a transfer that is still busy.
  [[nodiscard]] CanFrame start_upload(const SdoAddress& address, std::int64_t now_ns);
  /// Writes 1..kMaxBytes bytes; up to 4 go expedited.
  [[nodiscard]] CanFrame start_download(const SdoAddress& address,
                                        std::span<const std::uint8_t> data, std::int64_t now_ns);

  /// Takes in a frame; the next request where there is one.
  [[nodiscard]] std::optional<CanFrame> process(const CanFrame& frame, std::int64_t now_ns);
  /// Watches the time; an abort for the node where it fell silent.
  [[nodiscard]] std::optional<CanFrame> update(std::int64_t now_ns);

  [[nodiscard]] State state() const { return state_; }
  [[nodiscard]] std::uint32_t abort_code() const { return abort_code_; }
  /// What was uploaded, valid in kDone until the next start.
  [[nodiscard]] std::span<const std::uint8_t> data() const {
    return std::span(buffer_).first(size_);
  }
  /// The first bytes of data() as a number.
  [[nodiscard]] std::uint32_t value() const;

 private:
  enum class Phase : std::uint8_t { kUpload, kUploadSegment, kDownload, kDownloadSegment };

  void begin(const SdoAddress& address, Phase phase, std::int64_t now_ns);
  CanFrame abort(std::uint32_t code);
  std::optional<CanFrame> on_upload(const CanFrame& frame);
  std::optional<CanFrame> on_upload_segment(const CanFrame& frame);
  std::optional<CanFrame> on_download_accepted();
  CanFrame next_segment();
  [[nodiscard]] bool concerns(const CanFrame& frame) const;

  std::int64_t timeout_ns_;
  State state_ = State::kIdle;
  Phase phase_ = Phase::kUpload;
  SdoAddress address_;
  std::int64_t deadline_ns_ = 0;  ///< of the next answer
  std::int64_t end_ns_ = 0;       ///< of the transfer
  std::uint32_t abort_code_ = 0;
  bool toggle_ = false;
  std::array<std::uint8_t, kMaxBytes> buffer_{};
  std::size_t size_ = 0;  ///< bytes in the buffer
  std::size_t sent_ = 0;  ///< bytes of it that segments have carried
};

}  // namespace tenon::hw::canopen
