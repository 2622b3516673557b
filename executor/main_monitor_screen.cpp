#include "executor/main_monitor_screen.h"

#include <langinfo.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <array>
#include <clocale>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string_view>

// The wide variant's functions.
#define NCURSES_WIDECHAR 1
#define NCURSES_NOMACROS 1
#include <curses.h>

namespace tenon::executor {
namespace {

struct Look {
  Style style;
  short foreground;
  short background;
  attr_t attributes;  ///< with colour
  attr_t without;     ///< without
};
constexpr short kOwn = -1;  // the terminal's own colour

constexpr std::array<Look, 11> kLooks = {{
    {Style::kNormal, kOwn, kOwn, A_NORMAL, A_NORMAL},
    {Style::kDim, kOwn, kOwn, A_DIM, A_DIM},
    {Style::kTitle, kOwn, kOwn, A_BOLD, A_BOLD},
    {Style::kGood, COLOR_GREEN, kOwn, A_NORMAL, A_NORMAL},
    {Style::kWarn, COLOR_YELLOW, kOwn, A_BOLD, A_BOLD},
    {Style::kBad, COLOR_RED, kOwn, A_BOLD, A_BOLD},
    {Style::kContact, COLOR_CYAN, kOwn, A_BOLD, A_BOLD},
    {Style::kGoodBanner, COLOR_BLACK, COLOR_GREEN, A_NORMAL, A_REVERSE},
    {Style::kWarnBanner, COLOR_BLACK, COLOR_YELLOW, A_NORMAL, A_REVERSE | A_BOLD},
    {Style::kBadBanner, COLOR_WHITE, COLOR_RED, A_BOLD, A_REVERSE | A_BOLD},
    {Style::kKeys, kOwn, kOwn, A_REVERSE, A_REVERSE},
}};
static_assert(kLooks.size() == static_cast<std::size_t>(kLastStyle) + 1);

bool no_color() {
  const char* value = std::getenv("NO_COLOR");
  return value != nullptr && *value != '\0';
}

}  // namespace

// What a library says on standard error would stand in the middle of the screen.
struct Screen::Terminal {
  SCREEN* screen = nullptr;
  bool colour = false;
  int own_stderr = -1;
  std::FILE* said = nullptr;

  void keep_stderr() {
    if (::isatty(STDERR_FILENO) != 1) return;
    said = std::tmpfile();
    own_stderr = said == nullptr ? -1 : ::dup(STDERR_FILENO);
    if (own_stderr >= 0) ::dup2(::fileno(said), STDERR_FILENO);
  }
  void give_back_stderr() const {
    if (own_stderr >= 0) {
      (void)std::fflush(stderr);
      ::dup2(own_stderr, STDERR_FILENO);
      ::close(own_stderr);
      std::rewind(said);
      std::array<char, 4096> text{};
      for (std::size_t n = 0; (n = std::fread(text.data(), 1, text.size(), said)) > 0;) {
        (void)std::fwrite(text.data(), 1, n, stderr);
      }
    }
    if (said != nullptr) (void)std::fclose(said);
  }
};

std::unique_ptr<Screen> Screen::open() {
  const char* term = std::getenv("TERM");
  if (::isatty(STDOUT_FILENO) != 1 || term == nullptr || std::strcmp(term, "dumb") == 0)
    return nullptr;
  // Numbers stay as they are.
  (void)std::setlocale(LC_CTYPE, "");
  auto terminal = std::make_unique<Terminal>();
  terminal->screen = ::newterm(nullptr, stdout, stdin);
  if (terminal->screen == nullptr) return nullptr;
  return std::unique_ptr<Screen>(new Screen(std::move(terminal)));
}

Screen::Screen(std::unique_ptr<Terminal> terminal)
    : terminal_(std::move(terminal)),
      keys_(::isatty(STDIN_FILENO) == 1),
      ascii_(std::string_view(::nl_langinfo(CODESET)) != "UTF-8") {
  ::set_term(terminal_->screen);
  ::cbreak();
  ::noecho();
  ::nonl();
  ::nodelay(stdscr, TRUE);
  ::keypad(stdscr, TRUE);
  ::scrollok(stdscr, FALSE);
  (void)::curs_set(0);
  terminal_->colour = !no_color() && ::has_colors() && ::start_color() == OK;
  if (terminal_->colour) {
    (void)::use_default_colors();
    for (const Look& look : kLooks) {
      ::init_pair(static_cast<short>(static_cast<int>(look.style) + 1), look.foreground,
                  look.background);
    }
  }
  terminal_->keep_stderr();
}

Screen::~Screen() {
  ::endwin();
  ::delscreen(terminal_->screen);
  terminal_->give_back_stderr();
}

// Asked for and not waited for: ncurses tells of it by a key, and there may be no keyboard. A
// terminal that breaks its lines anew shows what nobody has drawn.
void Screen::take_size() {
  winsize size{};
  if (::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_row == 0 || size.ws_col == 0)
    return;
  if (size.ws_row == height_ && size.ws_col == width_) return;
  width_ = size.ws_col;
  height_ = size.ws_row;
  ::resizeterm(height_, width_);
  ::clearok(stdscr, TRUE);
}

int Screen::width() const { return ::getmaxx(stdscr); }
int Screen::height() const { return ::getmaxy(stdscr); }

void Screen::redraw() { ::clearok(stdscr, TRUE); }

void Screen::show(const std::vector<Line>& lines) {
  ::werase(stdscr);
  for (std::size_t row = 0; row < lines.size(); ++row) {
    ::wmove(stdscr, static_cast<int>(row), 0);
    for (const Glyph& glyph : lines[row]) {
      const Look& look = kLooks[static_cast<std::size_t>(glyph.style)];
      const std::array<wchar_t, 2> text = {
          static_cast<wchar_t>(ascii_ ? ascii_of(glyph.code) : glyph.code), 0};
      const auto pair =
          static_cast<short>(terminal_->colour ? static_cast<int>(look.style) + 1 : 0);
      cchar_t cell{};
      ::setcchar(&cell, text.data(), terminal_->colour ? look.attributes : look.without, pair,
                 nullptr);
      // Refuses what lies beyond the window, and the cursor behind its last glyph.
      (void)::wadd_wch(stdscr, &cell);
    }
  }
  ::wrefresh(stdscr);
}

int Screen::key() {
  if (!keys_) return 0;
  const int key = ::wgetch(stdscr);
  return key == ERR || key == KEY_RESIZE ? 0 : key;
}

}  // namespace tenon::executor
