#pragma once
// An MCAP file (https://mcap.dev/spec), written as it comes: messages in chunks with checksums, an
// index behind each, and a summary by which readers seek. Knows no file and no clock: bytes leave
// by a function. One thread.
//
//   file    = magic header {schema channel} {chunk {message index}} {metadata} data-end
//             summary footer magic
//   summary = {schema} {channel} statistics {chunk index} {metadata index} {summary offset}
//   record  = opcode u8, length u64, content; all numbers are little-endian
//   text    = length u32, UTF-8; a map or a list has its length in bytes, u32, before it
//
// Chunks are not compressed.

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "shared/base/crc32.h"

namespace tenon::executor {

/// What messages of a channel are: JSON, and the schema that says of what kind.
struct McapChannel {
  std::string topic;
  std::string schema_name;
  std::string json_schema;
};

class McapWriter {
 public:
  /// Gets all bytes of the file, in order. What it throws ends the file's making.
  using Sink = std::function<void(std::string_view bytes)>;
  using Texts = std::map<std::string, std::string>;

  /// @param library that makes the file, for whoever looks into it
  McapWriter(Sink sink, std::string_view library);

  /// Before the first message. @return for add(); channels of one schema name share its schema
  [[nodiscard]] std::uint16_t add_channel(const McapChannel& channel);
  /// @param time_ns since 1970, not negative; need not rise
  void add(std::uint16_t channel, std::int64_t time_ns, std::string_view message);
  /// All that is left, and what readers look for first. Nothing can be added any more.
  void finish(const std::string& metadata_name, const Texts& metadata);

  [[nodiscard]] std::uint64_t messages() const { return messages_; }

 private:
  struct Indexed {
    std::uint64_t time_ns;
    std::uint64_t offset;  ///< in the chunk
  };
  struct Span {
    std::uint64_t start_ns = 0;
    std::uint64_t end_ns = 0;
    void take(std::uint64_t time_ns, bool first);
  };
  void write(std::string_view bytes);
  void end_chunk();
  void write_metadata(const std::string& name, const Texts& texts);
  void write_summary();
  [[nodiscard]] std::string statistics() const;

  Sink sink_;
  Crc32 data_crc_;
  std::uint64_t at_ = 0;
  std::uint64_t messages_ = 0;
  Span span_;

  std::string schemas_;   ///< records, as the summary repeats them
  std::string channels_;  ///< the same
  std::map<std::string, std::uint16_t> schema_ids_;
  std::vector<std::uint32_t> sequences_;  ///< messages of each channel

  std::string chunk_;
  std::map<std::uint16_t, std::vector<Indexed>> chunk_index_;
  Span chunk_span_;
  std::string chunk_indexes_;  ///< records of the summary
  std::uint32_t chunks_ = 0;
  std::string metadata_indexes_;
};

}  // namespace tenon::executor
