// A device's description file (EDS, DCF) of any text: read into objects that hold together, or
// refused by one line; and a virtual drive in its likeness.

#include "shared/eds/device_file.h"

#include <cstddef>
#include <cstdint>
#include <string>

#include "sim/cell/devices/drive_402.h"
#include "tests/fuzz/support/refused.h"

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tenon;
  DeviceFile file;
  const std::string text(fuzz::text_of(data, size));
  if (!fuzz::accepted([&] { file = parse_device_file("input.eds", text); })) return 0;
  fuzz::must(!file.objects.empty(), "a file describes objects");
  for (const auto& [id, object] : file.objects) {
    fuzz::must(id <= 0xFFFFFF && object.line >= 1, "an object has a place");
    fuzz::must(!object.low || !object.high || *object.low <= *object.high, "limits have an order");
  }
  sim::Drive402 drive{sim::DriveParameters{}};
  drive.become_twin(file);
  drive.node().power_on(0);
  drive.advance(1'000'000);
  return 0;
}
