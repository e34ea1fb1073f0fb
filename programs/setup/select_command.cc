// SPDX-License-Identifier: GPL-2.0-or-later
// millwright select: selection of a configuration at a terminal.
#include "programs/setup/select_command.hh"

#include <unistd.h>

#include <array>
#include <cstdio>
#include <optional>

#include <fmt/format.h>

#include "base/language/language.hh"
#include "base/options/command_line.hh"
#include "base/stop_signals.hh"
#include "base/text.hh"
#include "programs/commands.hh"
#include "programs/setup/configurations.hh"
#include "programs/setup/first_steps.hh"
#include "programs/setup/ui_browser.hh"

namespace mw::programs {
namespace {

/// A configuration and its displayed number.
struct Choice {
    const ConfigurationGroup *group;
    const Configuration *configuration;
};

std::vector<Choice> show(const std::vector<ConfigurationGroup> &groups, const std::string &last) {
    std::vector<Choice> choices;
    for (const ConfigurationGroup &group : groups) {
        fmt::print("\n{}: {}{}\n", group.title, group.folder, group.isCopied ? " (starts your copy)" : "");
        for (const Configuration &one : group.configurations) {
            choices.push_back({&group, &one});
            fmt::print("{:>4}{} {:<36} {}\n", choices.size(), one.ini == last ? '*' : ' ',
                       printable(one.name), printable(one.machine));
        }
    }
    return choices;
}

/// Empty if nothing is to be started.
std::optional<Choice> ask(const std::vector<Choice> &choices, const std::string &last) {
    std::optional<Choice> preset;
    for (const Choice &choice : choices) {
        if (choice.configuration->ini == last) {
            preset = choice;
        }
    }
    while (stop_signal == 0) {
        fmt::print("\nNumber, part of a name,{} or q to quit: ", preset.has_value() ? " ENTER for *" : "");
        std::fflush(stdout);
        std::array<char, 256> line{};
        if (std::fgets(line.data(), line.size(), stdin) == nullptr) {
            return std::nullopt;
        }
        const std::string answer(trim(line.data()));
        if (answer == "q") {
            return std::nullopt;
        }
        if (answer.empty() && preset.has_value()) {
            return preset;
        }
        const auto number = parse_int(answer);
        if (number.has_value() && *number >= 1 && *number <= static_cast<std::int64_t>(choices.size())) {
            return choices[static_cast<std::size_t>(*number - 1)];
        }
        std::vector<Choice> found;
        for (const Choice &choice : choices) {
            if (!answer.empty() && choice.configuration->name.find(answer) != std::string::npos) {
                found.push_back(choice);
            }
        }
        if (found.size() == 1) {
            return found[0];
        }
        fmt::print("{}\n", language::shown(found.empty() ? "there is no such configuration"
                                                         : "several names match:"));
        for (const Choice &choice : found) {
            fmt::print("  {}\n", printable(choice.configuration->name));
        }
    }
    return std::nullopt;
}

}  // namespace

Result<std::string> select_configuration() {
    const std::vector<ConfigurationGroup> groups = find_configurations();
    if (groups.empty()) {
        return fail("no configuration found", {}, "LINUXCNC_AUX_CONFIGS names folders of configurations");
    }
    const std::string last = last_configuration();
    fmt::print("{}", language::shown("Machine configurations\n"));
    const auto choice = ask(show(groups, last), last);
    if (!choice.has_value()) {
        return std::string();
    }
    auto ini = choice->group->isCopied ? copy_sample(*choice->group, *choice->configuration)
                                       : Result<std::string>(choice->configuration->ini);
    if (ini.has_value()) {
        if (const auto kept = remember_configuration(*ini); !kept.has_value()) {
            return std::unexpected(kept.error());
        }
    }
    return ini;
}

int command_select(const std::vector<std::string> &arguments) {
    bool listed = false, printed = false, in_browser = false;
    int port = SCREEN_PORT;
    options::Words rest;
    options::CommandLine line("millwright select [options]",
                              "Lists the machine configurations on this computer, lets you select one, and "
                              "starts it as `linuxcnc` does.\n");
    line.flag("--list", "print the paths of all configurations and exit", listed);
    line.flag("--print", "print the path of the selected configuration instead of starting it", printed);
    line.flag("--browser", "show the configurations in a browser, with the wizard for new machines",
              in_browser);
    line.number("--port", "N", "with --browser: listen on 127.0.0.1:N (default 8850; 0: a free port)", port,
                0, 65535);
    line.rest(rest);
    line.footer("Searches ~/millwright/configs, ~/linuxcnc/configs, the folders of LINUXCNC_AUX_CONFIGS, the "
                "folder of\n`linuxcnc_var LINUXCNC_AUX_EXAMPLES`, and the samples.\nexit status: that of the "
                "display; 0 nothing selected, 1 failed, 2 wrong usage\n");
    if (options::wantsHelp(arguments)) {
        fmt::print("{}", line.help());
        return 0;
    }
    const auto parsed = line.parse(arguments);
    if (!parsed.has_value() || !rest.empty()) {
        fmt::print(stderr, "millwright select: {}\n",
                   parsed.has_value() ? "takes no arguments" : parsed.error().str());
        return 2;
    }
    if (listed) {
        for (const ConfigurationGroup &group : find_configurations()) {
            for (const Configuration &one : group.configurations) {
                fmt::print("{}\n", one.ini);
            }
        }
        return 0;
    }
    catch_stop_signals();
    const auto ini = in_browser ? select_in_browser(port, true) : select_configuration();
    if (!ini.has_value()) {
        fmt::print(stderr, "millwright select: {}\n", language::shown(ini.error().str()));
        return 1;
    }
    if (ini->empty()) {
        return 0;
    }
    if (printed) {
        fmt::print("{}\n", *ini);
        return 0;
    }
    return command_launch({*ini});
}

}  // namespace mw::programs
