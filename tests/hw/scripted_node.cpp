#include "tests/hw/scripted_node.h"

#include <algorithm>

namespace tenon::hw {
namespace {

std::uint32_t u32(const CanFrame& frame, std::size_t at) {
  return frame.data[at] | frame.data[at + 1] * 0x100u | frame.data[at + 2] * 0x10000u |
         frame.data[at + 3] * 0x1000000u;
}

std::uint8_t byte(std::uint32_t value, unsigned i) {
  return static_cast<std::uint8_t>(value >> (8 * i));
}

}  // namespace

ScriptedNode::ScriptedNode(Kind kind, std::uint8_t node, CanBus& bus)
    : kind_(kind), node_(node), bus_(bus) {
  reset_communication();
}

void ScriptedNode::reset_communication() {
  nmt_state = 0x7F;
  syncs_ = 0;
  objects[0x100000] = {4, kind_ == Kind::kDrive ? 0x00020192u : 0x00000194u};
  objects[0x101801] = {4, 0x0000ABCD};
  objects[0x101700] = {2, 0};
  const unsigned pdos = kind_ == Kind::kDrive ? 1 : 2;
  for (unsigned k = 0; k < pdos; ++k) {
    objects[0x180001 + (k << 8)] = {4, 0x180u + 0x100u * k + node_};
    objects[0x180002 + (k << 8)] = {1, 255};
    objects[0x1A0000 + (k << 8)] = {1, 0};
    for (unsigned sub = 1; sub <= 4; ++sub) objects[0x1A0000 + (k << 8) + sub] = {4, 0};
  }
  if (kind_ == Kind::kSensor) {
    objects[0x200200] = {2, 0};
    return;
  }
  for (unsigned k = 0; k < 2; ++k) {
    const std::uint32_t off = k == 0 ? 0 : 0x80000000u;
    objects[0x140001 + (k << 8)] = {4, off | (0x200u + 0x100u * k + node_)};
    objects[0x140002 + (k << 8)] = {1, 255};
    objects[0x140005 + (k << 8)] = {2, 0};
    objects[0x160000 + (k << 8)] = {1, 0};
    objects[0x160001 + (k << 8)] = objects[0x160002 + (k << 8)] = {4, 0};
  }
  pending_ = {};
  objects[0x180101] = {4, 0x280u + node_};  // a second TPDO that is on by default
  objects[0x101601] = objects[0x100600] = {4, 0};
  objects[0x600700] = objects[0x605A00] = objects[0x605B00] = objects[0x605C00] = {2, 0};
  objects[0x606500] = objects[0x608500] = {4, 0};
  objects[0x606600] = {2, 0};
  objects[0x60C201] = objects[0x60C202] = objects[0x606000] = objects[0x606100] = {1, 0};
  objects[0x650200] = {4, 0x80};
  for (const auto& [object, value] : default_mapping) objects[object].value = value;
}

void ScriptedNode::reboot() {
  reset_communication();
  statusword = 0x0250;
  send(0x700u + node_, {0x00});
}

void ScriptedNode::step(std::int64_t now_ns) {
  ReceivedFrame received;
  while (bus_.receive(received)) {
    const CanFrame& frame = received.frame;
    if (dead) continue;
    if (frame.id == 0x000) on_nmt(frame);
    if (frame.id == 0x080 && nmt_state == 0x05) on_sync();
    if (frame.id == 0x600u + node_) on_sdo(frame);
    for (unsigned k = 0; kind_ == Kind::kDrive && nmt_state == 0x05 && k < 2; ++k) {
      if (frame.id == objects[0x140001 + (k << 8)].value) on_rpdo(k, frame);
    }
  }
  end_quick_stop();
  const std::int64_t period_ns = objects[0x101700].value * 1'000'000LL;
  if (!dead && heartbeats && period_ns > 0 && now_ns >= next_heartbeat_ns_) {
    next_heartbeat_ns_ = now_ns + period_ns;
    send(0x700u + node_, {nmt_state});
  }
}

void ScriptedNode::send(std::uint32_t id, std::vector<std::uint8_t> bytes) {
  CanFrame frame;
  frame.id = id;
  frame.length = static_cast<std::uint8_t>(bytes.size());
  std::copy(bytes.begin(), bytes.end(), frame.data.begin());
  (void)bus_.send(frame);
}

void ScriptedNode::on_nmt(const CanFrame& frame) {
  if (frame.data[1] != 0 && frame.data[1] != node_) return;
  switch (frame.data[0]) {
    case 0x01:
      if (!ignores_start) nmt_state = 0x05;
      break;
    case 0x80:
      nmt_state = 0x7F;
      break;
    case 0x82:
      reset_communication();
      send(0x700u + node_, {0x00});
      break;
  }
}

void ScriptedNode::on_sdo(const CanFrame& frame) {
  const std::uint32_t object = frame.data[2] * 0x10000u | frame.data[1] * 0x100u | frame.data[3];
  if (mute_at == object || frame.data[0] == 0x80) return;
  if (const auto refusal = refuses.find(object); refusal != refuses.end()) {
    return answer(0x80, frame, refusal->second);
  }
  const auto found = objects.find(object);
  if (found == objects.end()) {
    return answer(0x80, frame, 0x06020000);
  }
  const std::uint8_t unused = static_cast<std::uint8_t>((4 - found->second.size_bytes) << 2);
  if (frame.data[0] == 0x40) {
    const auto kept = keeps.find(object);
    return answer(static_cast<std::uint8_t>(0x43 | unused), frame,
                  kept != keeps.end() ? kept->second : found->second.value);
  }
  if (read_only.contains(object)) {
    return answer(0x80, frame, 0x06010002);
  }
  if (frame.data[0] != (0x23 | unused)) {
    return answer(0x80, frame, 0x06070010);
  }
  found->second.value = u32(frame, 4);
  if (object == 0x606000) objects[0x606100].value = u32(frame, 4);
  writes.push_back({object, u32(frame, 4)});
  answer(0x60, frame, 0);
}

void ScriptedNode::answer(std::uint8_t command, const CanFrame& request, std::uint32_t value) {
  send(0x580u + node_, {command, request.data[1], request.data[2], request.data[3], byte(value, 0),
                        byte(value, 1), byte(value, 2), byte(value, 3)});
}

void ScriptedNode::on_rpdo(unsigned number, const CanFrame& frame) {
  commands.push_back(frame);
  if (objects[0x140002 + (number << 8)].value > 240) return act(number, frame);
  pending_[number] = frame;
}

void ScriptedNode::act(unsigned number, const CanFrame& frame) {
  const std::uint16_t before = controlword;
  std::size_t at = 0;
  for (unsigned sub = 1; sub <= objects[0x160000 + (number << 8)].value; ++sub) {
    switch (objects[0x160000 + (number << 8) + sub].value) {
      case 0x60400010:
        controlword = static_cast<std::uint16_t>(frame.data[at] | frame.data[at + 1] * 0x100);
        obey(before);
        at += 2;
        break;
      case 0x607A0020:
      case 0x60C10120:
        target_counts = static_cast<std::int32_t>(u32(frame, at));
        at += 4;
        break;
      case 0x00040020:  // somebody else's
        at += 4;
        break;
    }
  }
}

void ScriptedNode::on_sync() {
  if (kind_ == Kind::kSensor) {
    if (++syncs_ < objects[0x180002].value) return;
    syncs_ = 0;
    if (answers_sync) send_wrench();
    return;
  }
  for (unsigned k = 0; k < 2; ++k) {
    if (pending_[k]) act(k, *pending_[k]);
    pending_[k].reset();
  }
  if (follows && follows_targets()) position_counts = target_counts;
  if (answers_sync) send_feedback();
}

void ScriptedNode::send_wrench() {
  for (unsigned half = 0; half < 2; ++half) {
    if (half == 0 || tears) {
      sample_counter = static_cast<std::uint16_t>(sample_counter + samples_per_sync);
    }
    std::vector<std::uint8_t> bytes;
    for (unsigned i = 0; i < 3; ++i) {
      const auto bits = static_cast<std::uint16_t>(wrench_counts[3 * half + i]);
      bytes.push_back(byte(bits, 0));
      bytes.push_back(byte(bits, 1));
    }
    bytes.push_back(byte(sample_counter, 0));
    bytes.push_back(byte(sample_counter, 1));
    send(objects[0x180001 + (half << 8)].value & 0x7FF, bytes);
  }
}

void ScriptedNode::send_feedback() {
  std::vector<std::uint8_t> bytes;
  const auto append = [&bytes](std::uint32_t value, unsigned count) {
    for (unsigned i = 0; i < count; ++i) bytes.push_back(byte(value, i));
  };
  for (unsigned sub = 1; sub <= objects[0x1A0000].value; ++sub) {
    switch (objects[0x1A0000 + sub].value) {
      case 0x60410010: {
        const bool interpolates = objects[0x606100].value == 7 && follows_targets();
        append(statusword | (interpolates ? 0x1000u : 0u), 2);
        break;
      }
      case 0x60640020:
        append(static_cast<std::uint32_t>(position_counts), 4);
        break;
      case 0x60770010:
        append(static_cast<std::uint16_t>(torque_permille), 2);
        break;
    }
  }
  bytes.resize(tpdo_bytes);
  send(objects[0x180001].value & 0x7FF, bytes);
}

bool ScriptedNode::follows_targets() const {
  const bool interpolated = objects.at(0x606100).value == 7;
  return statusword == 0x0237 && (!interpolated || (controlword & 0x10) != 0);
}

/// With 605Ah = 2 a drive ramps down, closes its brake and goes off by itself.
void ScriptedNode::end_quick_stop() {
  constexpr int kSteps = 10;
  const bool over = objects[0x605A00].value == 2 && !stays_in_quick_stop;
  quick_stop_steps_ = statusword == 0x0217 && over ? quick_stop_steps_ + 1 : 0;
  if (quick_stop_steps_ > kSteps) statusword = 0x0250;
}

/// A controlword has arrived.
void ScriptedNode::obey(std::uint16_t before) {
  if (stuck) return;
  const bool reset = (controlword & 0x80) != 0 && (before & 0x80) == 0;
  switch (statusword) {
    case 0x0218:  // fault
      if (reset) statusword = 0x0250;
      break;
    case 0x0250:  // switch on disabled
      if (controlword == 0x06) statusword = 0x0231;
      break;
    case 0x0231:  // ready to switch on
      if (controlword == 0x07) statusword = 0x0233;
      if (controlword == 0x00) statusword = 0x0250;
      break;
    case 0x0233:  // switched on
      if (controlword == 0x0F) statusword = 0x0237;
      if (controlword == 0x06) statusword = 0x0231;
      break;
    case 0x0237:  // operation enabled
      if (controlword == 0x07) statusword = 0x0233;
      if (controlword == 0x02) statusword = 0x0217;
      break;
    case 0x0217:  // quick stop active
      if (controlword == 0x00) statusword = 0x0250;
      break;
  }
}

}  // namespace tenon::hw
