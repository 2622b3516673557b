#pragma once
// A terminal as a screen of styled glyphs and keys (ncurses). The terminal is as it was before once
// this is gone. One thread; one at a time.

#include <memory>
#include <vector>

#include "executor/monitor/styled.h"

namespace tenon::executor {

class Screen {
 public:
  /// Null where the terminal cannot be one (TERM unknown or dumb, output elsewhere).
  [[nodiscard]] static std::unique_ptr<Screen> open();
  Screen(const Screen&) = delete;
  Screen& operator=(const Screen&) = delete;
  /// Restores the terminal, and writes what was said on standard error meanwhile.
  ~Screen();

  /// Takes in the window's size of now, which width() and height() then give.
  void take_size();
  [[nodiscard]] int width() const;
  [[nodiscard]] int height() const;
  /// Somebody can press keys.
  [[nodiscard]] bool keys() const { return keys_; }
  /// All of it anew, whatever stands there now.
  void redraw();
  void show(const std::vector<Line>& lines);
  /// The key that was pressed, 0: none. Waits for nothing.
  [[nodiscard]] int key();

 private:
  struct Terminal;
  explicit Screen(std::unique_ptr<Terminal> terminal);

  std::unique_ptr<Terminal> terminal_;
  bool keys_ = false;
  bool ascii_ = false;
  int width_ = 0;
  int height_ = 0;
};

}  // namespace tenon::executor
