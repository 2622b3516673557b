#pragma once
// A minimal CANopen client for tests, written from CiA 301 alone: it shares neither code nor
// constants with the master in hw/ and the slaves in sim/, so that no mistake of theirs checks
// itself. Bytes in, bytes out; time is an argument. One SDO transfer at a time, expedited or
// segmented; it collects heartbeats, emergencies and whatever else arrives.
//
// It is a strict reader: what a server does against the standard is a complaint, and a test that
// wants none asserts that complaints are empty.

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace tenon::tests {

using Bytes = std::vector<std::uint8_t>;

struct WireFrame {
  std::uint32_t id = 0;
  Bytes data = {};
  bool remote = false;
};

class CanopenClient {
 public:
  enum class Transfer : std::uint8_t {
    kExpedited,         ///< at most 4 bytes, size told
    kExpeditedUnsized,  ///< the server knows the size
    kSegmented,         ///< size told
    kSegmentedUnsized,
  };

  struct Answer {
    std::uint32_t abort = 0;  ///< 0: the transfer succeeded
    Bytes bytes = {};         ///< of an upload
    bool segmented = false;   ///< how the server sent them
  };

  struct Emergency {
    std::uint16_t code = 0;
    std::uint8_t error_register = 0;
    friend bool operator==(const Emergency&, const Emergency&) = default;
  };

  explicit CanopenClient(std::uint8_t node) : node_(node) {}

  // Frames to send.
  [[nodiscard]] WireFrame nmt(std::uint8_t command) const { return {0x000, {command, node_}}; }
  [[nodiscard]] static WireFrame nmt_all(std::uint8_t command) { return {0x000, {command, 0}}; }
  [[nodiscard]] static WireFrame sync() { return {0x080, {}}; }
  [[nodiscard]] static WireFrame sync(std::uint8_t counter) { return {0x080, {counter}}; }
  [[nodiscard]] static WireFrame heartbeat(std::uint8_t node) { return {0x700U + node, {0x05}}; }

  /// Begins an upload or a download, and returns its first request.
  [[nodiscard]] WireFrame begin_read(std::uint16_t index, std::uint8_t sub, std::int64_t now_ns);
  [[nodiscard]] WireFrame begin_write(std::uint16_t index, std::uint8_t sub, const Bytes& bytes,
                                      Transfer transfer, std::int64_t now_ns);
  /// @return the next request of the transfer, if there is one
  [[nodiscard]] std::optional<WireFrame> receive(const WireFrame& frame, std::int64_t now_ns);
  /// A server that is silent for half a second: the client's abort 05040000h.
  [[nodiscard]] std::optional<WireFrame> advance(std::int64_t now_ns);

  /// Of the last transfer; unset while it runs.
  [[nodiscard]] const std::optional<Answer>& answer() const { return answer_; }

  std::vector<std::uint8_t> heartbeats;  ///< states, 0: boot-up
  std::vector<Emergency> emergencies;
  std::map<std::uint32_t, std::vector<Bytes>> others;  ///< by identifier
  std::vector<std::string> complaints;

 private:
  enum class Step : std::uint8_t {
    kIdle,
    kInitiateRead,
    kReadSegment,
    kInitiateWrite,
    kWriteSegment
  };

  [[nodiscard]] WireFrame request(std::uint8_t command) const;
  [[nodiscard]] std::optional<WireFrame> on_sdo(const Bytes& data);
  [[nodiscard]] std::optional<WireFrame> on_read_initiated(const Bytes& data);
  [[nodiscard]] std::optional<WireFrame> on_read_segment(const Bytes& data);
  [[nodiscard]] WireFrame next_write_segment();
  void finish(const Answer& answer);
  void expect(bool good, const std::string& complaint);

  std::uint8_t node_;
  Step step_ = Step::kIdle;
  std::uint16_t index_ = 0;
  std::uint8_t sub_ = 0;
  Bytes bytes_;
  std::size_t offset_ = 0;
  std::uint8_t toggle_ = 0;
  std::optional<std::uint32_t> announced_;
  std::int64_t asked_ns_ = 0;
  std::optional<Answer> answer_;
};

/// The low `size` bytes of a value, as CANopen sends them.
[[nodiscard]] Bytes little_endian(std::int64_t value, std::size_t size);
[[nodiscard]] std::uint64_t unsigned_of(const Bytes& bytes);
[[nodiscard]] std::int64_t signed_of(const Bytes& bytes);

}  // namespace tenon::tests
