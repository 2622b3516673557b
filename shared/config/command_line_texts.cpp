#include "shared/config/command_line_texts.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <set>
#include <sstream>
#include <vector>

namespace tenon {
namespace {

using Options = std::vector<const CLI::Option*>;
using Apps = std::vector<const CLI::App*>;

/// That have a page; each names the others.
constexpr std::array<const char*, 7> kPrograms = {"tenon-can",     "tenon-evaluate", "tenon-exec",
                                                  "tenon-inspect", "tenon-monitor",  "tenon-plan",
                                                  "tenon-sim"};

Apps subcommands_of(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App* sub) { return !sub->get_name().empty(); });
}

/// Text as man(7) takes it: no character is a command of it or becomes another one, so that what is
/// copied from the page can be typed; and lines stay lines.
std::string roff(const std::string& text) {
  std::string safe;
  bool begins = true;
  for (const char c : text) {
    if (begins && c == '.') safe += "\\&";
    begins = c == '\n';
    switch (c) {
      case '\\':
        safe += "\\e";
        break;
      case '-':
        safe += "\\-";
        break;
      case '\'':
        safe += "\\(aq";
        break;
      case '`':
        safe += "\\(ga";
        break;
      case '^':
        safe += "\\(ha";
        break;
      case '~':
        safe += "\\(ti";
        break;
      default:
        safe += c;
    }
  }
  return safe;
}

/// "-o", "--output"; of an argument without dashes its own name.
std::vector<std::string> names_of(const CLI::Option& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  if (names.empty()) names.push_back(option.get_name(true));
  return names;
}

/// What the option takes, as the help has it: "TEXT:{a,b}", "PLUG SOCKET"; none of a flag.
std::string takes(const CLI::Option& option) {
  if (!option.get_option_text().empty()) return option.get_option_text();
  return option.get_items_expected_max() == 0 ? std::string() : option.get_type_name();
}

/// What stands between the words of a list: a bar where the words themselves have commas.
char parting(const std::string& words) { return words.find('|') == std::string::npos ? ',' : '|'; }

/// The same for a reader: "a|b" of "TEXT:{a,b}", "INT in [1 - 9]" of "UINT:INT in [1 - 9]".
std::string value_of(const CLI::Option& option) {
  std::string type = takes(option);
  const std::size_t colon = type.find(':');
  if (colon == std::string::npos || colon + 1 == type.size()) return type;
  std::string value = type.substr(colon + 1);
  if (value.front() == '[') return type.substr(0, colon) + " in " + value;
  if (value.front() == '{' && value.back() == '}') {
    std::string words = value.substr(1, value.size() - 2);
    std::replace(words.begin(), words.end(), parting(words), '|');
    return words;
  }
  return value;
}

/// The words of "TEXT:{a,b}" or "TEXT:{a,b|c,d}", apart by blanks; none where there is no such
/// list.
std::string choices(const CLI::Option& option) {
  const std::string type = takes(option);
  const std::size_t begin = type.find('{');
  const std::size_t end = type.find('}', begin == std::string::npos ? 0 : begin);
  if (begin == std::string::npos || end == std::string::npos) return {};
  std::string words = type.substr(begin + 1, end - begin - 1);
  std::replace(words.begin(), words.end(), parting(words), ' ');
  return words;
}

std::string strung(const std::vector<std::string>& words, const char* between) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : between) + word;
  return text;
}

std::string option_paragraph(const CLI::Option& option) {
  std::string text = ".TP\n\\fB" + roff(strung(names_of(option), ", ")) + "\\fR";
  if (const std::string value = value_of(option); !value.empty()) {
    text += " \\fI" + roff(value) + "\\fR";
  }
  std::string words = option.get_description();
  if (!option.get_default_str().empty()) words += " (default: " + option.get_default_str() + ")";
  if (option.get_required()) words += " (required)";
  return text + "\n" + roff(words) + "\n";
}

/// A subcommand's --help is no news.
std::string option_paragraphs(const CLI::App& app) {
  std::string text;
  const auto add = [&](bool positional) {
    for (const CLI::Option* option : app.get_options()) {
      if (app.get_parent() != nullptr && option == app.get_help_ptr()) continue;
      if (option->get_positional() == positional) text += option_paragraph(*option);
    }
  };
  add(true);
  add(false);
  return text;
}

/// " task", " [task]": what stands on the command line without a name.
std::string arguments_of(const CLI::App& app) {
  std::string text;
  for (const CLI::Option* option : app.get_options()) {
    if (!option->get_positional()) continue;
    const std::string name = option->get_name(true);
    text += " " + (option->get_required() ? name : "[" + name + "]");
  }
  return text;
}

std::string synopsis(const CLI::App& app, const std::string& program) {
  std::string text = ".B " + roff(program) + "\n[OPTIONS]" + roff(arguments_of(app));
  if (!subcommands_of(app).empty()) {
    text += app.get_require_subcommand_min() == 0 ? " [SUBCOMMAND]" : " SUBCOMMAND";
  }
  return text + "\n";
}

/// As NAME has it, for apropos(1): no capital and no full stop.
std::string summary(const CLI::App& app) {
  std::string line = app.get_description();
  if (line.empty()) return line;
  line.front() = static_cast<char>(std::tolower(static_cast<unsigned char>(line.front())));
  if (line.back() == '.') line.pop_back();
  return line;
}

/// "  1  the plan failed" as a paragraph with the number beside it; any other line goes on with it.
std::string status_line(const std::string& line) {
  const std::size_t begin = std::min(line.find_first_not_of(' '), line.size());
  if (begin == line.size() || std::isdigit(static_cast<unsigned char>(line[begin])) == 0) {
    return roff(line.substr(begin)) + "\n";
  }
  const std::size_t words = std::min(line.find_first_not_of(' ', begin + 1), line.size());
  return std::string(".TP\n") + line[begin] + "\n" + roff(line.substr(words)) + "\n";
}

/// The sections of a footer, whose parts have a blank line between them: under "Exit status:" and
/// "Examples:" their lines, two blanks in; others are notes.
std::string sections_of(const std::string& footer) {
  std::string status;
  std::string examples;
  std::string notes;
  std::string title;
  std::istringstream lines(footer);
  for (std::string line; std::getline(lines, line);) {
    if (line.empty() || line == "Exit status:" || line == "Examples:") {
      title = line;
    } else if (title == "Exit status:") {
      status += status_line(line);
    } else if (title == "Examples:") {
      examples += roff(line.starts_with("  ") ? line.substr(2) : line) + "\n";
    } else {
      notes += roff(line) + "\n";
    }
  }
  if (status.empty()) {
    status =
        ".TP\n0\nSuccess.\n.TP\n1\nThe task failed; the last line says why.\n"
        ".TP\n2\nBad usage or bad input.\n";
  }
  std::string text = ".SH EXIT STATUS\n" + status;
  if (!examples.empty()) text += ".SH EXAMPLES\n.nf\n" + examples + ".fi\n";
  if (!notes.empty()) text += ".SH NOTES\n" + notes;
  return text;
}

std::string see_also(const std::string& program) {
  std::string text;
  for (const char* other : kPrograms) {
    if (other == program) continue;
    text += (text.empty() ? ".BR " : ",\n.BR ") + roff(other) + " (1)";
  }
  return ".SH SEE ALSO\n" + text + "\n";
}

/// Without arguments, and without its subcommands'.
Options own_options(const CLI::App& app) {
  return app.get_options([](const CLI::Option* option) { return !option->get_positional(); });
}

/// Of the program and of all its subcommands.
Options all_options(const CLI::App& app) {
  Options options = own_options(app);
  for (const CLI::App* sub : subcommands_of(app)) {
    const Options more = all_options(*sub);
    options.insert(options.end(), more.begin(), more.end());
  }
  return options;
}

/// "--can --help": every name of each.
std::string names_of_all(const Options& options, const char* between) {
  std::set<std::string> words;
  for (const CLI::Option* option : options) {
    const std::vector<std::string> names = names_of(*option);
    words.insert(names.begin(), names.end());
  }
  return strung({words.begin(), words.end()}, between);
}

/// What is completed, and the option that it would be the value of. Bash takes --option=value
/// apart, unless it was told not to.
constexpr const char* kWordAndOption =
    "  local word=${COMP_WORDS[COMP_CWORD]} option=${COMP_WORDS[COMP_CWORD - 1]} glued=\n"
    "  if [[ $word == = ]]; then\n"
    "    word=\n"
    "  elif [[ $option == = && $COMP_CWORD -gt 2 ]]; then\n"
    "    option=${COMP_WORDS[COMP_CWORD - 2]}\n"
    "  elif [[ $word == --*=* ]]; then\n"
    "    option=${word%%=*} glued=${word%%=*}= word=${word#*=}\n"
    "  fi\n";

/// Sets `at` to where a subcommand stands: behind the program's own options and their values, which
/// bash takes apart at colons and equals signs.
std::string subcommands_place(const CLI::App& app) {
  Options with_value = own_options(app);
  std::erase_if(with_value, [](const CLI::Option* option) { return takes(*option).empty(); });
  std::string text =
      "  local at=1\n"
      "  while [[ $at -lt $COMP_CWORD && ${COMP_WORDS[at]} == -* ]]; do\n"
      "    case ${COMP_WORDS[at]} in\n    ";
  text += names_of_all(with_value, "|");
  return text +
         ")\n"
         "      ((at++))\n"
         "      if [[ ${COMP_WORDS[at]} == = ]]; then ((at++)); fi\n"
         "      while [[ ${COMP_WORDS[at + 1]} == [:=]* ]]; do ((at += 2)); done\n"
         "      ;;\n"
         "    esac\n"
         "    ((at++))\n"
         "  done\n";
}

/// Sets `options` to those that may stand here: the program's own, or its subcommand's.
std::string options_here(const CLI::App& app) {
  std::string text = "  local options=\"" + names_of_all(own_options(app), " ") + "\"\n";
  const Apps subcommands = subcommands_of(app);
  if (subcommands.empty()) return text;
  text += "  if [[ $at -lt $COMP_CWORD ]]; then\n    case ${COMP_WORDS[at]} in\n";
  for (const CLI::App* sub : subcommands) {
    text += "    " + sub->get_name() + ") options=\"" + names_of_all(own_options(*sub), " ") +
            "\" ;;\n";
  }
  return text + "    esac\n  fi\n";
}

/// What a text is, the type does not say: it is another word where it is no file.
bool may_be_file(const CLI::Option& option) {
  return choices(option).empty() && option.get_type_name().starts_with("TEXT");
}

/// The end of a case, for a value that is no file: the words that it is one of, or nothing. What
/// begins with a dash may be the next option, of one whose value may be left out.
std::string offered_values(const CLI::Option& option) {
  if (const std::string values = choices(option); !values.empty()) {
    return "      COMPREPLY=($(compgen -P \"$glued\" -W \"" + values +
           "\" -- \"$word\"))\n      return\n      ;;\n";
  }
  return "      if [[ $word != -* ]]; then return; fi\n      ;;\n";
}

/// Of the arguments of the subcommand that stands `at`: what is no file.
std::string arguments_here(const CLI::App& app) {
  std::string cases;
  for (const CLI::App* sub : subcommands_of(app)) {
    int place = 0;
    for (const CLI::Option* option : sub->get_options()) {
      if (!option->get_positional()) continue;
      ++place;
      if (may_be_file(*option)) continue;
      cases +=
          "    " + sub->get_name() + "-" + std::to_string(place) + ")\n" + offered_values(*option);
    }
  }
  if (cases.empty()) return {};
  return "  case ${COMP_WORDS[at]}-$((COMP_CWORD - at)) in\n" + cases + "  esac\n";
}

}  // namespace

std::string manual_page(const CLI::App& app, const std::string& program,
                        const std::string& version) {
  std::string text = ".TH " + roff(program) + " 1 \"\" \"Tenon " + roff(version) +
                     "\" \"User Commands\"\n.SH NAME\n" + roff(program) + " \\- " +
                     roff(summary(app)) + "\n.SH SYNOPSIS\n" + synopsis(app, program) +
                     ".SH OPTIONS\n" + option_paragraphs(app);
  const Apps subcommands = subcommands_of(app);
  if (!subcommands.empty()) text += ".SH SUBCOMMANDS\n";
  for (const CLI::App* sub : subcommands) {
    text += ".SS " + roff(sub->get_name() + arguments_of(*sub)) + "\n" +
            roff(sub->get_description()) + "\n" + option_paragraphs(*sub);
  }
  text += sections_of(app.get_footer());
  text +=
      ".SH FILES\n.TP\n\\fIshare/tenon\\fR\nBelow the prefix of the installation: documents, "
      "README.md first, and the files of tasks, robots and cells that ship.\n";
  return text + see_also(program);
}

std::string bash_completion(const CLI::App& app, const std::string& program) {
  std::string function = "_" + program;
  std::replace(function.begin(), function.end(), '-', '_');
  std::string cases;
  for (const CLI::Option* option : all_options(app)) {
    if (takes(*option).empty() || may_be_file(*option)) continue;
    cases += "    " + strung(names_of(*option), "|") + ")\n" + offered_values(*option);
  }
  std::vector<std::string> subcommands;
  for (const CLI::App* sub : subcommands_of(app)) subcommands.push_back(sub->get_name());
  std::string text = function + "() {\n" + kWordAndOption;
  if (!cases.empty()) text += "  case $option in\n" + cases + "  esac\n";
  if (!subcommands.empty()) text += subcommands_place(app);
  text += options_here(app) +
          "  if [[ -z $glued && $word == -* ]]; then\n"
          "    COMPREPLY=($(compgen -W \"$options\" -- \"$word\"))\n    return\n  fi\n";
  if (!subcommands.empty()) {
    text += "  if [[ $at -eq $COMP_CWORD ]]; then\n    COMPREPLY=($(compgen -W \"" +
            strung(subcommands, " ") + "\" -- \"$word\"))\n    return\n  fi\n" +
            arguments_here(app);
  }
  // A name of a file may hold blanks.
  text += "  local IFS=$'\\n'\n  COMPREPLY=($(compgen -P \"$glued\" -f -- \"$word\"))\n}\n";
  return text + "complete -o filenames -F " + function + " " + program + "\n";
}

}  // namespace tenon
