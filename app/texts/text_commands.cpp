#include <algorithm>

#include <fmt/format.h>

#include <barchan/app/options.hpp>
#include <barchan/app/texts/texts.hpp>
#include <barchan/core/base/error.hpp>
#include <barchan/core/base/nearest.hpp>
#include <barchan/core/io/text_file.hpp>
#include <barchan/tasks/results/run_summary.hpp>

namespace barchan::app {
namespace {

std::vector<std::string> names_of_commands(const CLI::App& root) {
  std::vector<std::string> names;
  for (const CLI::App* command : root.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(command->get_name());
  return names;
}

}  // namespace

void add_texts(CLI::App& root, TextWords& words) {
  root.add_subcommand("schema", "Print the deck as a JSON Schema, for editors");
  CLI::App& completion =
      *root.add_subcommand("completion", "Print the completion of this command for a shell");
  completion.add_option("shell", words.shell, "The shell")
      ->required()
      ->type_name("SHELL")
      ->check(one_of({"bash", "zsh", "fish"}));
  CLI::App& man = *root.add_subcommand("man", "Print a manual page of this command");
  man.add_option("page", words.page, "The command that it is of; default: of all")
      ->type_name("COMMAND")
      ->check(not_empty());
  man.add_option("--out", words.pages, "Write all pages into this folder instead")
      ->type_name("DIR")
      ->check(not_empty());
}

std::string text_of(const CLI::App& root, const TextWords& words) {
  if (root.got_subcommand("schema")) return deck_schema();
  if (root.got_subcommand("completion")) return completion_for(root, words.shell);
  const std::string title = "barchan " + version();
  std::vector<std::string> names = names_of_commands(root);
  if (words.pages.empty()) {
    const std::vector<std::string_view> views(names.begin(), names.end());
    if (!words.page.empty() && std::find(names.begin(), names.end(), words.page) == names.end())
      throw InputError(fmt::format("there is no command '{}'", words.page),
                       deck::suggest(words.page, views));
    return man_page(root, words.page, title);
  }
  names.emplace_back();
  for (const std::string& name : names) {
    OutputFile file(words.pages + "/barchan" + (name.empty() ? "" : "-" + name) + ".1");
    file.write(man_page(root, name, title));
    file.commit();
  }
  return {};
}

}  // namespace barchan::app
