#include "executor/export/mcap_writer.h"

#include <algorithm>
#include <cassert>
#include <span>
#include <utility>

#include "shared/base/bytes.h"

namespace tenon::executor {
namespace {

using namespace std::string_view_literals;

constexpr std::string_view kMagic = "\x89MCAP0\r\n"sv;
constexpr std::size_t kChunk_bytes = 1U << 20U;

enum class Opcode : std::uint8_t {
  kHeader = 0x01,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kMessageIndex = 0x07,
  kChunkIndex = 0x08,
  kStatistics = 0x0B,
  kMetadata = 0x0C,
  kMetadataIndex = 0x0D,
  kSummaryOffset = 0x0E,
  kDataEnd = 0x0F,
};

template <WireNumber Number>
void put(std::string& bytes, Number value) {
  std::array<std::uint8_t, sizeof(Number)> here{};
  store_le(std::span(here), value);
  bytes.append(here.begin(), here.end());
}

void put_text(std::string& bytes, std::string_view text) {
  put(bytes, static_cast<std::uint32_t>(text.size()));
  bytes += text;
}

std::string record(Opcode opcode, std::string_view content) {
  std::string bytes(1, static_cast<char>(opcode));
  put(bytes, std::uint64_t{content.size()});
  bytes += content;
  return bytes;
}

std::span<const std::uint8_t> span_of(std::string_view bytes) {
  return {reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()};
}

std::uint32_t crc_of(std::string_view bytes) {
  Crc32 crc;
  crc.add(span_of(bytes));
  return crc.value();
}

}  // namespace

void McapWriter::Span::take(std::uint64_t time_ns, bool first) {
  start_ns = first ? time_ns : std::min(start_ns, time_ns);
  end_ns = first ? time_ns : std::max(end_ns, time_ns);
}

McapWriter::McapWriter(Sink sink, std::string_view library) : sink_(std::move(sink)) {
  std::string content;
  put_text(content, "");  // no profile: those are ROS's
  put_text(content, library);
  write(kMagic);
  write(record(Opcode::kHeader, content));
}

void McapWriter::write(std::string_view bytes) {
  data_crc_.add(span_of(bytes));
  sink_(bytes);
  at_ += bytes.size();
}

std::uint16_t McapWriter::add_channel(const McapChannel& channel) {
  assert(messages_ == 0);
  std::string records;
  const auto next_schema = static_cast<std::uint16_t>(schema_ids_.size() + 1);
  const auto [schema, is_new] = schema_ids_.try_emplace(channel.schema_name, next_schema);
  if (is_new) {
    std::string content;
    put(content, schema->second);
    put_text(content, channel.schema_name);
    put_text(content, "jsonschema");
    put_text(content, channel.json_schema);
    records = record(Opcode::kSchema, content);
    schemas_ += records;
  }
  const auto id = static_cast<std::uint16_t>(sequences_.size());
  sequences_.push_back(0);
  std::string content;
  put(content, id);
  put(content, schema->second);
  put_text(content, channel.topic);
  put_text(content, "json");
  put(content, std::uint32_t{0});  // no metadata
  const std::string channel_record = record(Opcode::kChannel, content);
  channels_ += channel_record;
  write(records + channel_record);
  return id;
}

void McapWriter::add(std::uint16_t channel, std::int64_t time_ns, std::string_view message) {
  const auto time = static_cast<std::uint64_t>(time_ns);
  chunk_span_.take(time, chunk_.empty());
  span_.take(time, messages_ == 0);
  chunk_index_[channel].push_back({time, chunk_.size()});
  std::string content;
  put(content, channel);
  put(content, sequences_.at(channel)++);
  put(content, time);
  put(content, time);
  content += message;
  chunk_ += record(Opcode::kMessage, content);
  ++messages_;
  if (chunk_.size() >= kChunk_bytes) end_chunk();
}

void McapWriter::end_chunk() {
  if (chunk_.empty()) return;
  const std::uint64_t chunk_at = at_;
  std::string content;
  put(content, chunk_span_.start_ns);
  put(content, chunk_span_.end_ns);
  put(content, std::uint64_t{chunk_.size()});
  put(content, crc_of(chunk_));
  put_text(content, "");  // not compressed
  put(content, std::uint64_t{chunk_.size()});
  content += chunk_;
  write(record(Opcode::kChunk, content));

  const std::uint64_t indexes_at = at_;
  std::string offsets;
  for (const auto& [channel, messages] : chunk_index_) {
    put(offsets, channel);
    put(offsets, at_);
    std::string index;
    for (const Indexed& message : messages) {
      put(index, message.time_ns);
      put(index, message.offset);
    }
    std::string of_channel;
    put(of_channel, channel);
    put_text(of_channel, index);
    write(record(Opcode::kMessageIndex, of_channel));
  }

  std::string summary;
  put(summary, chunk_span_.start_ns);
  put(summary, chunk_span_.end_ns);
  put(summary, chunk_at);
  put(summary, indexes_at - chunk_at);
  put_text(summary, offsets);
  put(summary, at_ - indexes_at);
  put_text(summary, "");
  put(summary, std::uint64_t{chunk_.size()});
  put(summary, std::uint64_t{chunk_.size()});
  chunk_indexes_ += record(Opcode::kChunkIndex, summary);
  ++chunks_;
  chunk_.clear();
  chunk_index_.clear();
}

void McapWriter::write_metadata(const std::string& name, const Texts& texts) {
  std::string map;
  for (const auto& [key, text] : texts) {
    put_text(map, key);
    put_text(map, text);
  }
  std::string content;
  put_text(content, name);
  put_text(content, map);
  const std::string metadata = record(Opcode::kMetadata, content);
  std::string index;
  put(index, at_);
  put(index, std::uint64_t{metadata.size()});
  put_text(index, name);
  metadata_indexes_ += record(Opcode::kMetadataIndex, index);
  write(metadata);
}

std::string McapWriter::statistics() const {
  std::string counts;
  for (std::size_t id = 0; id < sequences_.size(); ++id) {
    put(counts, static_cast<std::uint16_t>(id));
    put(counts, std::uint64_t{sequences_[id]});
  }
  std::string content;
  put(content, messages_);
  put(content, static_cast<std::uint16_t>(schema_ids_.size()));
  put(content, static_cast<std::uint32_t>(sequences_.size()));
  put(content, std::uint32_t{0});  // attachments
  put(content, std::uint32_t{1});  // metadata
  put(content, chunks_);
  put(content, span_.start_ns);
  put(content, span_.end_ns);
  put_text(content, counts);
  return record(Opcode::kStatistics, content);
}

void McapWriter::write_summary() {
  const std::uint64_t summary_at = at_;
  std::string summary;
  std::string offsets;
  const auto add_group = [&](Opcode opcode, const std::string& records) {
    if (records.empty()) return;
    std::string content(1, static_cast<char>(opcode));
    put(content, summary_at + summary.size());
    put(content, std::uint64_t{records.size()});
    offsets += record(Opcode::kSummaryOffset, content);
    summary += records;
  };
  add_group(Opcode::kSchema, schemas_);
  add_group(Opcode::kChannel, channels_);
  add_group(Opcode::kStatistics, statistics());
  add_group(Opcode::kChunkIndex, chunk_indexes_);
  add_group(Opcode::kMetadataIndex, metadata_indexes_);
  const std::uint64_t offsets_at = summary_at + summary.size();
  summary += offsets;

  // The checksum covers the summary and the footer up to it.
  constexpr std::uint64_t kFooter_bytes = 20;
  summary += static_cast<char>(Opcode::kFooter);
  put(summary, kFooter_bytes);
  put(summary, summary_at);
  put(summary, offsets_at);
  put(summary, crc_of(summary));
  write(summary);
}

void McapWriter::finish(const std::string& metadata_name, const Texts& metadata) {
  end_chunk();
  write_metadata(metadata_name, metadata);
  std::string content;
  put(content, data_crc_.value());
  write(record(Opcode::kDataEnd, content));
  write_summary();
  write(kMagic);
}

}  // namespace tenon::executor
