#include "sim/cell/canopen/eds.h"

#include <vector>

#include "shared/base/text.h"
#include "shared/canopen/constants.h"

namespace tenon::sim {
namespace {

using Indices = std::vector<std::uint16_t>;

std::string hex(std::uint64_t value, int digits = 1) {
  return format("%0*llX", digits, static_cast<unsigned long long>(value));
}

/// CiA 301, 7.4.7.1: index of the data type.
int type_code(DataType type) {
  switch (type) {
    case DataType::kI8:
      return 0x0002;
    case DataType::kI16:
      return 0x0003;
    case DataType::kI32:
      return 0x0004;
    case DataType::kU8:
      return 0x0005;
    case DataType::kU16:
      return 0x0006;
    case DataType::kU32:
      return 0x0007;
    case DataType::kText:
      return 0x0009;
  }
  return 0;
}

/// Object codes of CiA 301: 7 variable, 8 array, 9 record.
int object_code(Structure structure) {
  switch (structure) {
    case Structure::kVariable:
      return 7;
    case Structure::kArray:
      return 8;
    case Structure::kRecord:
      return 9;
  }
  return 0;
}

const char* access_type(const ObjectEntry& entry) {
  switch (entry.access) {
    case Access::kReadOnly:
      return "ro";
    case Access::kWriteOnly:
      return "wo";
    case Access::kReadWrite:
      return entry.mappable == Mappable::kReceive ? "rww" : "rw";
  }
  return "";
}

/// Decimal where it has a sign, else hexadecimal.
std::string number(const ObjectEntry& entry, std::int64_t value) {
  return is_signed(entry.type) ? std::to_string(value)
                               : "0x" + hex(static_cast<std::uint64_t>(value));
}

/// Lines "key=value" in sections.
class Writer {
 public:
  void section(const std::string& name) {
    text_ += (text_.empty() ? "[" : "\r\n[") + name + "]\r\n";
  }
  void line(const std::string& key, const std::string& value) {
    text_ += key + "=" + value + "\r\n";
  }
  void line(const std::string& key, int value) { line(key, std::to_string(value)); }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  std::string text_;
};

std::string default_value(const ObjectEntry& entry, std::uint8_t node) {
  if (entry.type == DataType::kText) return entry.factory_text;
  if (!entry.contains_node) return number(entry, entry.factory_value);
  return "$NODEID+0x" + hex(static_cast<std::uint64_t>(entry.factory_value - node));
}

void write_entry(Writer& out, const std::string& name, const ObjectEntry& entry,
                 std::uint8_t node) {
  out.line("ParameterName", name);
  out.line("ObjectType", "0x7");
  out.line("DataType", "0x" + hex(static_cast<unsigned>(type_code(entry.type)), 4));
  out.line("AccessType", access_type(entry));
  if (entry.type != DataType::kText && entry.low > lowest(entry.type)) {
    out.line("LowLimit", number(entry, entry.low));
  }
  if (entry.type != DataType::kText && entry.high < highest(entry.type)) {
    out.line("HighLimit", number(entry, entry.high));
  }
  out.line("DefaultValue", default_value(entry, node));
  out.line("PDOMapping", entry.mappable == Mappable::kNo ? 0 : 1);
}

/// The sub-indices that an index has, in order.
std::vector<const std::pair<const ObjectId, ObjectEntry>*> subs_of(
    const ObjectDictionary& dictionary, std::uint16_t index) {
  std::vector<const std::pair<const ObjectId, ObjectEntry>*> subs;
  const auto end = dictionary.entries().upper_bound(object_id(index, 0xFF));
  for (auto entry = dictionary.entries().lower_bound(object_id(index)); entry != end; ++entry) {
    subs.push_back(&*entry);
  }
  return subs;
}

void write_object(Writer& out, const ObjectDictionary& dictionary, std::uint16_t index,
                  std::uint8_t node) {
  const auto subs = subs_of(dictionary, index);
  const ObjectDictionary::Description* description = dictionary.description(index);
  out.section(hex(index, 4));
  if (description == nullptr) {
    write_entry(out, subs.front()->second.name, subs.front()->second, node);
    return;
  }
  out.line("ParameterName", description->name);
  out.line("ObjectType", "0x" + hex(static_cast<unsigned>(object_code(description->structure))));
  out.line("SubNumber", "0x" + hex(subs.size()));
  for (const auto* sub : subs) {
    out.section(hex(index, 4) + "sub" + hex(sub->first & 0xFF));
    write_entry(out, sub->second.name, sub->second, node);
  }
}

void write_list(Writer& out, const std::string& name, const Indices& indices) {
  out.section(name);
  out.line("SupportedObjects", static_cast<int>(indices.size()));
  for (std::size_t i = 0; i < indices.size(); ++i) {
    out.line(std::to_string(i + 1), "0x" + hex(indices[i], 4));
  }
}

int count_between(const Indices& indices, std::uint16_t low, std::uint16_t high) {
  int count = 0;
  for (const std::uint16_t index : indices) count += index >= low && index <= high ? 1 : 0;
  return count;
}

void write_head(Writer& out, const ObjectDictionary& dictionary, const EdsInfo& info,
                const Indices& indices) {
  const auto identity = [&](std::uint8_t sub) {
    const ObjectEntry* entry = dictionary.find(object_id(canopen::kIdentity, sub));
    return entry == nullptr ? std::string("0x0") : number(*entry, entry->factory_value);
  };
  out.section("FileInfo");
  out.line("FileName", info.file_name);
  out.line("FileVersion", 1);
  out.line("FileRevision", 0);
  out.line("EDSVersion", "4.0");
  out.line("Description", info.product_name);
  out.line("CreatedBy", "tenon-sim");
  out.section("DeviceInfo");
  out.line("VendorName", "none");
  out.line("VendorNumber", identity(1));
  out.line("ProductName", info.product_name);
  out.line("ProductNumber", identity(2));
  out.line("RevisionNumber", identity(3));
  for (const int kbps : {10, 20, 50, 125, 250, 500, 800, 1000}) {
    out.line("BaudRate_" + std::to_string(kbps), 1);
  }
  out.line("SimpleBootUpMaster", 0);
  out.line("SimpleBootUpSlave", 1);
  out.line("Granularity", 8);
  out.line("DynamicChannelsSupported", 0);
  out.line("GroupMessaging", 0);
  out.line("NrOfRXPDO", count_between(indices, 0x1400, 0x15FF));
  out.line("NrOfTXPDO", count_between(indices, 0x1800, 0x19FF));
  out.line("LSS_Supported", 0);
  out.section("DummyUsage");
  out.line("Dummy0001", 0);
  for (int type = 2; type <= 7; ++type) out.line("Dummy000" + std::to_string(type), 1);
  out.section("Comments");
  out.line("Lines", 0);
}

bool is_mandatory(std::uint16_t index) {
  return index == canopen::kDeviceType || index == canopen::kErrorRegister ||
         index == canopen::kIdentity;
}

bool is_manufacturers(std::uint16_t index) { return index >= 0x2000 && index <= 0x5FFF; }

}  // namespace

std::string eds_text(const ObjectDictionary& dictionary, const EdsInfo& info) {
  Indices all;
  Indices mandatory;
  Indices manufacturers;
  Indices optional;
  for (const auto& [id, entry] : dictionary.entries()) {
    const auto index = static_cast<std::uint16_t>(id >> 8);
    if (!all.empty() && all.back() == index) continue;
    all.push_back(index);
    (is_mandatory(index)       ? mandatory
     : is_manufacturers(index) ? manufacturers
                               : optional)
        .push_back(index);
  }
  Writer out;
  write_head(out, dictionary, info, all);
  write_list(out, "MandatoryObjects", mandatory);
  write_list(out, "OptionalObjects", optional);
  write_list(out, "ManufacturerObjects", manufacturers);
  for (const std::uint16_t index : all) write_object(out, dictionary, index, info.node);
  return out.text();
}

}  // namespace tenon::sim
