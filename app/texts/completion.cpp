#include <algorithm>

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include <barchan/app/texts/texts.hpp>
#include <barchan/tasks/simulation.hpp>

namespace barchan::app {
namespace {

std::string joined(const std::vector<std::string>& words, const char* separator = " ") {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : separator) + word;
  return text;
}

std::vector<const CLI::App*> commands_of(const CLI::App& root) {
  return root.get_subcommands([](const CLI::App*) { return true; });
}

std::vector<const CLI::Option*> options_of(const CLI::App& command) {
  return command.get_options([](const CLI::Option* o) { return !o->get_lnames().empty(); });
}

/// For the quotes of every shell.
std::string plain(std::string text) {
  std::erase_if(text, [](char c) { return std::string("'\"[]`\\$").find(c) != std::string::npos; });
  std::replace(text.begin(), text.end(), ':', ';');
  return text;
}

std::vector<std::string> names_of(const CLI::Option& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  return names;
}

std::string bash(const CLI::App& root) {
  std::string words, options, values;
  for (const CLI::App* command : commands_of(root)) {
    words += " " + command->get_name();
    std::vector<std::string> names;
    for (const CLI::Option* option : options_of(*command)) {
      const auto own = names_of(*option);
      names.insert(names.end(), own.begin(), own.end());
      const auto choices = choices_of(*option);
      if (!choices.empty())
        values += fmt::format("    '{} {}') words='{}' ;;\n", command->get_name(), own.front(),
                              joined(choices));
    }
    options += fmt::format("      {}) words='{}' ;;\n", command->get_name(), joined(names));
  }
  return "# Completion of barchan for bash; barchan completion bash prints it.\n"
         "_barchan() {\n"
         "  local cur=${COMP_WORDS[COMP_CWORD]} prev=${COMP_WORDS[COMP_CWORD-1]} words=\n"
         "  if ((COMP_CWORD == 1)); then\n"
         "    mapfile -t COMPREPLY < <(compgen -W '" +
         words.substr(1) +
         " --help --version' -- \"$cur\")\n"
         "    return\n"
         "  fi\n"
         "  case \"${COMP_WORDS[1]} $prev\" in\n" +
         values +
         "  esac\n"
         "  if [[ -z $words && $cur == -* ]]; then\n"
         "    case ${COMP_WORDS[1]} in\n" +
         options +
         "    esac\n"
         "  fi\n"
         "  if [[ -n $words ]]; then\n"
         "    mapfile -t COMPREPLY < <(compgen -W \"$words\" -- \"$cur\")\n"
         "  else\n"
         "    mapfile -t COMPREPLY < <(compgen -f -- \"$cur\")\n"
         "  fi\n"
         "}\n"
         "complete -o filenames -F _barchan barchan\n";
}

std::string zsh(const CLI::App& root) {
  std::string words, cases;
  for (const CLI::App* command : commands_of(root)) {
    words += fmt::format("    '{}:{}'\n", command->get_name(), plain(command->get_description()));
    cases += fmt::format("    {})\n      _arguments", command->get_name());
    for (const CLI::Option* option : options_of(*command)) {
      const auto choices = choices_of(*option);
      std::string value;
      if (takes_word(*option))
        value = choices.empty() ? ":value:_files" : ":value:(" + joined(choices) + ")";
      cases += fmt::format(" \\\n        '{}[{}]{}'", names_of(*option).front(),
                           plain(option->get_description()), value);
    }
    cases += " \\\n        '*:file:_files' ;;\n";
  }
  return "#compdef barchan\n"
         "# Completion of barchan for zsh; barchan completion zsh prints it.\n"
         "_barchan() {\n"
         "  local -a commands=(\n" +
         words +
         "  )\n"
         "  if (( CURRENT == 2 )); then\n"
         "    _describe command commands\n"
         "    return\n"
         "  fi\n"
         "  shift words\n"
         "  (( CURRENT-- ))\n"
         "  case $words[1] in\n" +
         cases +
         "  esac\n"
         "}\n"
         "_barchan \"$@\"\n";
}

std::string fish(const CLI::App& root) {
  std::string text = "# Completion of barchan for fish; barchan completion fish prints it.\n";
  for (const CLI::App* command : commands_of(root)) {
    text += fmt::format("complete -c barchan -f -n __fish_use_subcommand -a {} -d '{}'\n",
                        command->get_name(), plain(command->get_description()));
    for (const CLI::Option* option : options_of(*command)) {
      const auto choices = choices_of(*option);
      std::string value;
      if (takes_word(*option)) value = choices.empty() ? " -r" : " -xa '" + joined(choices) + "'";
      text +=
          fmt::format("complete -c barchan -n '__fish_seen_subcommand_from {}' -l {}{} -d '{}'\n",
                      command->get_name(), option->get_lnames().front(), value,
                      plain(option->get_description()));
    }
  }
  return text;
}

}  // namespace

bool takes_word(const CLI::Option& option) {
  return option.get_type_size_max() > 0;
}

std::vector<std::string> choices_of(const CLI::Option& option) {
  if (!option.get_lnames().empty() &&
      (option.get_lnames().front() == "exchange" || option.get_lnames().front() == "record"))
    return exchange_choices();
  const std::string type = option.get_type_name();
  const auto begin = type.find('{'), end = type.find('}');
  if (begin == std::string::npos || end == std::string::npos) return {};
  std::vector<std::string> words(1);
  for (const char c : type.substr(begin + 1, end - begin - 1)) {
    if (c == ',')
      words.emplace_back();
    else if (c != ' ')
      words.back().push_back(c);
  }
  return words;
}

std::string completion_for(const CLI::App& root, const std::string& shell) {
  if (shell == "bash") return bash(root);
  return shell == "zsh" ? zsh(root) : fish(root);
}

}  // namespace barchan::app
