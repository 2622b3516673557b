#include "shared/config/command_line_texts.h"

#include <algorithm>
#include <set>
#include <vector>

namespace tenon {
namespace {

using Options = std::vector<const CLI::Option*>;
using Apps = std::vector<const CLI::App*>;

Apps subcommands_of(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App* sub) { return !sub->get_name().empty(); });
}

/// Text as man(7) takes it: no character is a command of it, and lines stay lines.
std::string roff(const std::string& text) {
  std::string safe;
  bool begins = true;
  for (const char c : text) {
    if (begins && (c == '.' || c == '\'')) safe += "\\&";
    begins = c == '\n';
    if (c == '\\') {
      safe += "\\e";
    } else if (c == '-') {
      safe += "\\-";
    } else {
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

/// The words of "TEXT:{a,b}", apart by blanks; none where there is no such list.
std::string choices(const CLI::Option& option) {
  const std::string type = takes(option);
  const std::size_t begin = type.find('{');
  const std::size_t end = type.find('}', begin == std::string::npos ? 0 : begin);
  if (begin == std::string::npos || end == std::string::npos) return {};
  std::string words = type.substr(begin + 1, end - begin - 1);
  std::replace(words.begin(), words.end(), ',', ' ');
  return words;
}

std::string strung(const std::vector<std::string>& words, const char* between) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : between) + word;
  return text;
}

std::string option_paragraph(const CLI::Option& option) {
  std::string text = ".TP\n\\fB" + roff(strung(names_of(option), ", ")) + "\\fR";
  if (const std::string type = takes(option); !type.empty()) text += " \\fI" + roff(type) + "\\fR";
  text += "\n" + roff(option.get_description());
  if (!option.get_default_str().empty()) text += " (" + roff(option.get_default_str()) + ")";
  if (option.get_required()) text += " (required)";
  return text + "\n";
}

std::string option_paragraphs(const CLI::App& app) {
  std::string text;
  const auto add = [&](bool positional) {
    for (const CLI::Option* option : app.get_options()) {
      if (option->get_positional() == positional) text += option_paragraph(*option);
    }
  };
  add(true);
  add(false);
  return text;
}

std::string synopsis(const CLI::App& app, const std::string& program) {
  std::string text = ".B " + roff(program) + "\n[OPTIONS]";
  for (const CLI::Option* option : app.get_options()) {
    if (!option->get_positional()) continue;
    const std::string name = option->get_name(true);
    text += " " + roff(option->get_required() ? name : "[" + name + "]");
  }
  if (!subcommands_of(app).empty()) text += " SUBCOMMAND";
  return text + "\n";
}

/// Of the program and of all its subcommands.
Options all_options(const CLI::App& app) {
  Options options;
  for (const CLI::Option* option : app.get_options()) {
    if (!option->get_positional()) options.push_back(option);
  }
  for (const CLI::App* sub : subcommands_of(app)) {
    const Options more = all_options(*sub);
    options.insert(options.end(), more.begin(), more.end());
  }
  return options;
}

}  // namespace

std::string manual_page(const CLI::App& app, const std::string& program,
                        const std::string& version) {
  std::string text = ".TH " + roff(program) + " 1 \"\" \"Tenon " + roff(version) +
                     "\" \"User Commands\"\n.SH NAME\n" + roff(program) + " \\- " +
                     roff(app.get_description()) + "\n.SH SYNOPSIS\n" + synopsis(app, program) +
                     ".SH OPTIONS\n" + option_paragraphs(app);
  const Apps subcommands = subcommands_of(app);
  if (!subcommands.empty()) text += ".SH SUBCOMMANDS\n";
  for (const CLI::App* sub : subcommands) {
    text += ".SS " + roff(sub->get_name()) + "\n" + roff(sub->get_description()) + "\n" +
            option_paragraphs(*sub);
  }
  text +=
      ".SH EXIT STATUS\n.TP\n0\nSuccess.\n.TP\n1\nThe task failed; the last line says why.\n"
      ".TP\n2\nBad usage or bad input.\n";
  if (!app.get_footer().empty()) text += ".SH EXAMPLES\n.nf\n" + roff(app.get_footer()) + "\n.fi\n";
  return text;
}

std::string bash_completion(const CLI::App& app, const std::string& program) {
  std::string function = "_" + program;
  std::replace(function.begin(), function.end(), '-', '_');
  std::set<std::string> words;
  std::string cases;
  for (const CLI::Option* option : all_options(app)) {
    const std::vector<std::string> names = names_of(*option);
    words.insert(names.begin(), names.end());
    if (const std::string values = choices(*option); !values.empty()) {
      cases += "    " + strung(names, "|") + ")\n      COMPREPLY=($(compgen -W \"" + values +
               "\" -- \"$word\"))\n      return\n      ;;\n";
    }
  }
  std::vector<std::string> subcommands;
  for (const CLI::App* sub : subcommands_of(app)) subcommands.push_back(sub->get_name());
  std::string text = function + "() {\n  local word=${COMP_WORDS[COMP_CWORD]}\n";
  if (!cases.empty()) text += "  case ${COMP_WORDS[COMP_CWORD - 1]} in\n" + cases + "  esac\n";
  text += "  if [[ $word == -* ]]; then\n    COMPREPLY=($(compgen -W \"" +
          strung({words.begin(), words.end()}, " ") +
          "\" -- \"$word\"))\n  else\n    COMPREPLY=($(compgen -W \"" + strung(subcommands, " ") +
          "\" -- \"$word\") $(compgen -f -- \"$word\"))\n  fi\n}\n";
  return text + "complete -o filenames -F " + function + " " + program + "\n";
}

}  // namespace tenon
