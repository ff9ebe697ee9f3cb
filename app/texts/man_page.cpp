#include <algorithm>
#include <cctype>

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include <barchan/app/texts/texts.hpp>

namespace barchan::app {
namespace {

/// A text that roff takes as it is: no escapes, no requests at the beginning of a line.
std::string roff(const std::string& text) {
  std::string safe;
  bool is_at_begin = true;
  for (const char c : text) {
    if (is_at_begin && (c == '.' || c == '\'')) safe += "\\&";
    if (c == '\\')
      safe += "\\e";
    else if (c == '-')
      safe += "\\-";
    else
      safe.push_back(c);
    is_at_begin = c == '\n';
  }
  return safe;
}

std::string upper(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return text;
}

/// "KEY=VALUE" of "KEY=VALUE:{a, b}".
std::string type_of(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const std::string name = type.substr(0, type.find_first_of(":{ "));
  const auto choices = choices_of(option);
  const bool is_listed = !choices.empty() && type.find('{') != std::string::npos;
  if (!is_listed) return name.empty() ? "WORD" : name;
  std::string words;
  for (const std::string& word : choices) words += (words.empty() ? "" : "|") + word;
  return words;
}

std::string options_of(const CLI::App& command) {
  std::string text;
  for (const CLI::Option* option : command.get_options()) {
    text += ".TP\n";
    if (option->get_positional()) {
      text += "\\fI" + roff(option->get_type_name().substr(0, option->get_type_name().find(':'))) +
              "\\fR\n";
    } else {
      std::string names;
      for (const std::string& name : option->get_snames()) names += "\\fB\\-" + name + "\\fR, ";
      for (const std::string& name : option->get_lnames())
        names += "\\fB\\-\\-" + roff(name) + "\\fR, ";
      names.resize(names.size() - 2);
      text += names + (takes_word(*option) ? " \\fI" + roff(type_of(*option)) + "\\fR" : "") + "\n";
    }
    text += roff(option->get_description()) + "\n";
  }
  return text;
}

std::string synopsis(const CLI::App& command) {
  std::string text = "\\fBbarchan " + command.get_name() + "\\fR";
  for (const CLI::Option* option : command.get_options()) {
    if (!option->get_positional()) continue;
    const std::string type = option->get_type_name();
    text += " \\fI" + roff(type.substr(0, type.find(':'))) + "\\fR";
  }
  return text + " [\\fIoptions\\fR]\n";
}

std::string head(const std::string& name, const std::string& version, const std::string& about) {
  return fmt::format(".TH {} 1 \"\" \"{}\" \"User Commands\"\n.SH NAME\n{} \\- {}\n.SH SYNOPSIS\n",
                     upper(roff(name)), roff(version), roff(name), roff(about));
}

std::string status() {
  return ".SH EXIT STATUS\n"
         "0 done; 1 failed while running; 2 wrong input.\n";
}

}  // namespace

std::string man_page(const CLI::App& root, const std::string& name, const std::string& version) {
  if (name.empty()) {
    std::string text = head("barchan", version, "discrete element method on MPI and oneTBB") +
                       "\\fBbarchan\\fR \\fICOMMAND\\fR [\\fIoptions\\fR]\n.SH DESCRIPTION\n" +
                       roff(root.get_description()) + "\n.SH COMMANDS\n";
    for (const CLI::App* command : root.get_subcommands([](const CLI::App*) { return true; }))
      text += ".TP\n\\fBbarchan\\-" + command->get_name() + "\\fR(1)\n" +
              roff(command->get_description()) + "\n";
    return text + status();
  }
  const CLI::App& command = *root.get_subcommand(name);
  std::string text = head("barchan-" + name, version, command.get_description()) +
                     synopsis(command) + ".SH OPTIONS\n" + options_of(command);
  if (!command.get_footer().empty())
    text += ".SH NOTES\n.nf\n" + roff(command.get_footer()) + "\n.fi\n";
  return text + status() + ".SH SEE ALSO\n\\fBbarchan\\fR(1)\n";
}

}  // namespace barchan::app
