#include "executor/export/column.h"

namespace tenon::executor {

const char* to_string(ValueKind kind) {
  switch (kind) {
    case ValueKind::kTruth:
      return "boolean";
    case ValueKind::kCount:
      return "integer";
    case ValueKind::kNumber:
      return "number";
    case ValueKind::kText:
      return "string";
  }
  return "?";
}

}  // namespace tenon::executor
