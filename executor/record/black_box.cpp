#include "executor/record/black_box.h"

#include <algorithm>
#include <array>
#include <sstream>

#include "executor/states/ending.h"
#include "shared/base/error.h"
#include "shared/base/text.h"
#include "shared/system/record_file.h"

namespace tenon::executor {
namespace {

constexpr std::array<const char*, 4> kQuaternion = {"qw", "qx", "qy", "qz"};

void write_header(std::ostream& out) {
  out << "sequence,time_ns,motion_ns,state,arm_state,request,end_reason,step,phase,moving,"
         "wrench_fresh,signature,joints_fresh,wakeup_late_ns,compute_ns,late_cycles";
  for (const char* what : {"pose", "setpoint", "commanded"}) {
    for (std::size_t i = 0; i < 3; ++i) out << ',' << what << '_' << kAxisNames[i] << "_m";
    for (const char* q : kQuaternion) out << ',' << what << '_' << q;
  }
  for (std::size_t i = 0; i < 6; ++i) {
    out << ",velocity_" << kAxisNames[i] << (i < 3 ? "_mps" : "_radps");
  }
  for (const char* what : {"wrench", "wrench_raw"}) {
    for (std::size_t i = 0; i < 6; ++i) {
      out << ',' << what << '_' << kAxisNames[i] << (i < 3 ? "_N" : "_Nm");
    }
  }
  for (const char* what : {"position", "position_commanded"}) {
    for (std::size_t i = 0; i < kMaxJoints; ++i) out << ',' << what << '_' << i;
  }
  out << ",slip_joint,slip_moved,slip_bound,brakes_unwatched\n";
}

void write_record(std::ostream& out, const CycleRecord& r) {
  const auto number = [](auto enumerator) { return static_cast<int>(enumerator); };
  out << r.sequence << ',' << r.time_ns << ',' << r.motion_ns << ',' << number(r.state) << ','
      << number(r.arm_state) << ',' << number(r.request) << ','
      << to_string(static_cast<EndReason>(r.end_reason)) << ',' << r.step << ',' << number(r.phase)
      << ',' << r.moving << ',' << r.wrench_fresh << ',' << r.signature << ',' << r.joints_fresh
      << ',' << r.wakeup_late_ns << ',' << r.compute_ns << ',' << r.late_cycles;
  const auto write = [&](const auto& values) {
    for (const double value : values) out << ',' << value;
  };
  for (const PoseData* pose : {&r.pose, &r.setpoint, &r.commanded}) {
    write(pose->position_m);
    write(pose->orientation_wxyz);
  }
  write(r.velocity);
  write(r.wrench);
  write(r.wrench_raw);
  write(r.position);
  write(r.position_commanded);
  out << ',' << r.slip.joint << ',' << r.slip.moved << ',' << r.slip.bound << ','
      << r.brakes_unwatched << '\n';
}

}  // namespace

std::size_t BlackBox::size() const { return std::min(count_, records_.size()); }

const CycleRecord& BlackBox::at(std::size_t i) const {
  return records_[(count_ - size() + i) % records_.size()];
}

RecordReport BlackBox::write_csv(const std::filesystem::path& file) const {
  try {
    RecordFile box("black_box", file);
    std::ostringstream heading;
    write_header(heading);
    box.add(heading.str(), 0);
    for (std::size_t i = 0; i < size(); ++i) {
      std::ostringstream line;
      line.precision(12);
      write_record(line, at(i));
      box.add(line.str());
    }
    box.close();
    return box.report();
  } catch (const InputError& error) {
    return {"black_box", file.string(), 0, size(), error.what()};
  }
}

}  // namespace tenon::executor
