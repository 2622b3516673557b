#include "hw/can/candump_log.h"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "shared/base/error.h"

namespace tenon::hw {

std::string candump_line(const ReceivedFrame& record, const std::string& interface) {
  const CanFrame& frame = record.frame;
  const std::int64_t time_us = record.time_ns / 1000;
  char text[48];
  std::snprintf(text, sizeof(text), "(%lld.%06lld) ", static_cast<long long>(time_us / 1'000'000),
                static_cast<long long>(time_us % 1'000'000));
  std::string line = text + interface;
  std::snprintf(text, sizeof(text), frame.extended ? " %08X#" : " %03X#", frame.id);
  line += text;
  const unsigned length = std::min<unsigned>(frame.length, 8);
  if (frame.remote) {
    return line + "R" + std::to_string(length);
  }
  for (std::size_t i = 0; i < length; ++i) {
    std::snprintf(text, sizeof(text), "%02X", static_cast<unsigned>(frame.data[i]));
    line += text;
  }
  return line;
}

CandumpLog::CandumpLog(const std::filesystem::path& file, std::string interface)
    : stream_(file, std::ios::trunc), interface_(std::move(interface)) {
  if (!stream_) {
    throw InputError("CAN log " + file.string() +
                     ": cannot be written; check the folder and its permissions");
  }
}

void CandumpLog::drain(CanRecordRing& ring) {
  ReceivedFrame record;
  while (ring.pop(record)) {
    stream_ << candump_line(record, interface_) << '\n';
  }
  stream_.flush();
}

}  // namespace tenon::hw
