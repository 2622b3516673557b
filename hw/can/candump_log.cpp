#include "hw/can/candump_log.h"

#include <algorithm>
#include <utility>

#include "shared/base/text.h"

namespace tenon::hw {

std::string candump_line(const ReceivedFrame& record, const std::string& interface) {
  const CanFrame& frame = record.frame;
  const std::int64_t time_us = record.time_ns / 1000;
  std::string line = format("(%lld.%06lld) ", static_cast<long long>(time_us / 1'000'000),
                            static_cast<long long>(time_us % 1'000'000));
  line += interface + format(frame.extended ? " %08X#" : " %03X#", frame.id);
  const unsigned length = std::min<unsigned>(frame.length, 8);
  if (frame.remote) {
    return line + "R" + std::to_string(length);
  }
  for (std::size_t i = 0; i < length; ++i) {
    line += format("%02X", static_cast<unsigned>(frame.data[i]));
  }
  return line;
}

CandumpLog::CandumpLog(const std::filesystem::path& file, Interfaces interfaces,
                       std::int64_t unix_offset_ns)
    : file_("can_log", file), interfaces_(std::move(interfaces)), unix_offset_ns_(unix_offset_ns) {}

void CandumpLog::drain(CanRecordRing& ring) {
  ReceivedFrame record;
  while (ring.pop(record)) {
    record.time_ns += unix_offset_ns_;
    file_.add(candump_line(record, interfaces_[record.frame.bus == 0 ? 0 : 1]) + '\n');
  }
  file_.flush();
}

RecordReport CandumpLog::close(CanRecordRing& ring) {
  drain(ring);
  file_.close();
  RecordReport report = file_.report();
  if (ring.dropped() > 0) report.lose(ring.dropped(), "written too slowly");
  return report;
}

}  // namespace tenon::hw
