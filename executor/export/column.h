#pragma once
// What a message says, as columns of a table: one list makes a table's head, its rows, objects of
// JSON and their schema. Pure; allocates.

#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "executor/export/value.h"

namespace tenon::executor {

/// A message with what its file and its run say of its time.
template <typename Message>
struct Timed {
  Message message;
  std::int64_t log_time_us = 0;  ///< when it was logged, since 1970
  std::int64_t since_ns = 0;     ///< the first cycle of its run
};

enum class ValueKind : std::uint8_t { kTruth, kCount, kNumber, kText };

/// As JSON schema has it: "boolean", "integer", "number", "string".
[[nodiscard]] const char* to_string(ValueKind kind);

template <typename Message>
struct Column {
  std::string name;  ///< its unit comes last
  ValueKind kind;
  std::string meaning;
  std::function<Value(const Timed<Message>&)> value;
};

template <typename Message>
class Columns {
 public:
  /// The two that every table begins with.
  Columns() {
    columns_.push_back({"time_s", ValueKind::kNumber, "since the first cycle of the run",
                        [](const auto& told) -> Value { return seconds(told.since_ns); }});
    columns_.push_back({"log_time_us", ValueKind::kCount, "when it was logged, since 1970",
                        [](const auto& told) -> Value { return told.log_time_us; }});
  }

  /// @param get Value(const Message&)
  template <typename Get>
  void truth(std::string name, std::string meaning, Get get) {
    add(std::move(name), ValueKind::kTruth, std::move(meaning), std::move(get));
  }
  template <typename Get>
  void count(std::string name, std::string meaning, Get get) {
    add(std::move(name), ValueKind::kCount, std::move(meaning), std::move(get));
  }
  template <typename Get>
  void number(std::string name, std::string meaning, Get get) {
    add(std::move(name), ValueKind::kNumber, std::move(meaning), std::move(get));
  }
  template <typename Get>
  void text(std::string name, std::string meaning, Get get) {
    add(std::move(name), ValueKind::kText, std::move(meaning), std::move(get));
  }

  [[nodiscard]] const std::vector<Column<Message>>& all() const { return columns_; }

  /// The names, comma between; no end of line.
  [[nodiscard]] std::string csv_head() const {
    std::string text;
    for (const Column<Message>& column : columns_) {
      if (!text.empty()) text += ',';
      add_csv(column.name, text);
    }
    return text;
  }
  void add_csv_row(const Timed<Message>& told, std::string& text) const {
    bool first = true;
    for (const Column<Message>& column : columns_) {
      if (!std::exchange(first, false)) text += ',';
      add_csv(column.value(told), text);
    }
  }
  /// What is known of it, by the columns' names.
  [[nodiscard]] std::string json(const Timed<Message>& told) const {
    std::string text = "{";
    for (const Column<Message>& column : columns_) {
      const Value value = column.value(told);
      if (!is_known(value)) continue;
      if (text.size() > 1) text += ',';
      text += json_text(column.name);
      text += ':';
      add_json(value, text);
    }
    return text + "}";
  }
  [[nodiscard]] std::string json_schema(std::string_view title) const {
    std::string text = "{\"title\":" + json_text(title) + ",\"type\":\"object\",\"properties\":{";
    for (const Column<Message>& column : columns_) {
      if (&column != &columns_.front()) text += ',';
      text += json_text(column.name) + ":{\"type\":\"" + to_string(column.kind) +
              "\",\"description\":" + json_text(column.meaning) + "}";
    }
    return text + "}}";
  }

 private:
  template <typename Get>
  void add(std::string name, ValueKind kind, std::string meaning, Get get) {
    columns_.push_back({std::move(name), kind, std::move(meaning),
                        [get = std::move(get)](const Timed<Message>& told) -> Value {
                          return get(told.message);
                        }});
  }

  std::vector<Column<Message>> columns_;
};

}  // namespace tenon::executor
