// SPDX-License-Identifier: GPL-2.0-or-later
#include "programs/setup/first_steps.hh"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>

#include "base/ini/ini_file.hh"
#include "base/stop_signals.hh"
#include "base/text.hh"
#include "clients/screen/access/secrets.hh"
#include "clients/screen/server/server.hh"
#include "programs/setup/changed_machine.hh"
#include "programs/setup/new_machine.hh"
#include "programs/setup/steps_process.hh"
#include "programs/setup/ui_browser.hh"

namespace mw::programs {
namespace {

namespace fs = std::filesystem;
using screen::Choice;
using screen::FirstStepsSetup;

std::string value_of(const ini::IniFile &ini, const char *section, const char *key) {
    const ini::IniEntry *const entry = ini.find(section, key);
    return entry != nullptr ? std::string(trim(entry->value)) : "";
}

bool isYes(const std::string &value) {
    const std::string small = to_lower(value);
    return small == "1" || small == "yes" || small == "true" || small == "on";
}

/// Comments before the first section, without the licence line.
std::string notes_of(const std::string &path) {
    constexpr std::size_t LONGEST = 600;
    std::string notes;
    std::ifstream file(path);
    for (std::string line; std::getline(file, line) && notes.size() < LONGEST;) {
        std::string_view words = trim(line);
        if (words.empty() || words.find("SPDX-License-Identifier") != std::string_view::npos) {
            continue;
        }
        if (words[0] != '#' && words[0] != ';') {
            break;
        }
        words = trim(words.substr(std::min(words.find_first_not_of("#; "), words.size())));
        notes += (notes.empty() || words.empty() ? "" : " ") + std::string(words);
    }
    return notes.substr(0, LONGEST);
}

/// The picture with the name of the INI file, otherwise the splash picture of the screen.
std::string picture_of(const fs::path &ini, const std::string &intro) {
    std::error_code error;
    for (const char *ending : {".png", ".jpg", ".jpeg", ".gif", ".svg"}) {
        fs::path picture = ini;
        picture.replace_extension(ending);
        if (fs::is_regular_file(picture, error)) {
            return picture.string();
        }
    }
    const fs::path picture = ini.parent_path() / intro;
    return !intro.empty() && fs::is_regular_file(picture, error) ? picture.string() : "";
}

std::string kind_of(const ini::IniFile &ini, const std::string &axes) {
    if (isYes(value_of(ini, "DISPLAY", "LATHE")) || isYes(value_of(ini, "DISPLAY", "BACK_TOOL_LATHE"))) {
        return "lathe";
    }
    if (isYes(value_of(ini, "DISPLAY", "FOAM"))) {
        return "foam";
    }
    if (!value_of(ini, "KINS", "KINEMATICS").starts_with("trivkins")) {
        return "other";
    }
    std::string letters = axes;
    std::ranges::sort(letters);
    return std::ranges::adjacent_find(letters) != letters.end() ? "gantry" : "mill";
}

std::int64_t now_ns() {
    return std::chrono::steady_clock::now().time_since_epoch() / std::chrono::nanoseconds(1);
}

std::vector<screen::ChoiceGroup> find_choices() {
    std::vector<screen::ChoiceGroup> groups;
    for (const ConfigurationGroup &group : find_configurations()) {
        screen::ChoiceGroup shown{group.title, group.folder, group.isCopied, {}};
        for (const Configuration &one : group.configurations) {
            shown.choices.push_back(choice_of(one));
        }
        groups.push_back(std::move(shown));
    }
    return groups;
}

/// Copies a sample to the user's folder, and remembers the configuration for the next start.
Result<FirstStepsSetup::Start> prepare(const std::string &ini) {
    std::string path = ini;
    for (const ConfigurationGroup &group : find_configurations()) {
        const auto one = std::ranges::find(group.configurations, ini, &Configuration::ini);
        if (group.isCopied && one != group.configurations.end()) {
            auto copy = copy_sample(group, *one);
            if (!copy.has_value()) {
                return std::unexpected(copy.error());
            }
            path = std::move(*copy);
        }
    }
    if (const auto kept = remember_configuration(path); !kept.has_value()) {
        return std::unexpected(kept.error());
    }
    diagnostics::Sink ignored;
    const auto file = ini::IniFile::load(path, ignored);
    if (!file.has_value()) {
        return std::unexpected(file.error());
    }
    return FirstStepsSetup::Start{path, screen_port(value_of(*file, "DISPLAY", "DISPLAY"))};
}

Result<FirstStepsSetup> make_setup() {
    auto key = screen::random_secret();
    if (!key.has_value()) {
        return std::unexpected(key.error());
    }
    const char *const home = std::getenv("HOME");
    FirstStepsSetup setup;
    setup.screen_folder = screen_folder("");
    setup.key = std::move(*key);
    setup.find = find_choices;
    setup.last = last_configuration;
    setup.make = [](const std::string &folder, const setup::Plan &plan,
                    const setup::Answers &given) -> Result<FirstStepsSetup::Made> {
        auto made = make_machine(folder, plan, given);
        return made.has_value() ? Result<FirstStepsSetup::Made>({made->ini, made->program})
                                : std::unexpected(made.error());
    };
    setup.try_out = [](const FirstStepsSetup::Made &made) -> Result<std::string> {
        auto trial = try_machine({made.ini, made.program});
        if (!trial.has_value()) {
            return std::unexpected(trial.error());
        }
        return trial->good ? Result<std::string>(std::move(trial->output)) : fail(trial->output);
    };
    setup.prepare = prepare;
    setup.commission = start_steps;
    setup.proposed_folder = std::string(home != nullptr ? home : "/tmp") + "/millwright/configs";
    return setup;
}

}  // namespace

Choice choice_of(const Configuration &configuration) {
    Choice choice{configuration.ini, configuration.name, configuration.machine, "other", {}, {}, {}, {}};
    diagnostics::Sink ignored;
    const auto ini = ini::IniFile::load(configuration.ini, ignored);
    if (!ini.has_value()) {
        return choice;
    }
    for (const char c : value_of(*ini, "TRAJ", "COORDINATES")) {
        choice.axes += c == ' ' || c == '\t' ? "" : to_upper(std::string(1, c));
    }
    const std::string unit = to_lower(value_of(*ini, "TRAJ", "LINEAR_UNITS"));
    choice.unit = unit.starts_with("in") ? "inch" : unit == "mm" || unit == "metric" ? "mm" : "";
    choice.kind = kind_of(*ini, choice.axes);
    choice.notes = notes_of(configuration.ini);
    choice.picture = picture_of(configuration.ini, value_of(*ini, "DISPLAY", "INTRO_GRAPHIC"));
    const auto answers = recorded_answers(fs::path(configuration.ini).parent_path().string());
    if (answers.has_value()) {
        const setup::Plan plan = setup::plan_of(*answers).plan;
        choice.hasSteps = plan.hasBoard();
        choice.isSimulated = plan.wiring.isSimulated;
    }
    return choice;
}

int screen_port(const std::string &display) {
    const auto words = split_words(display);
    if (words.empty() || words[0] != "millwright") {
        return 0;
    }
    const auto option = std::ranges::find(words, "--port");
    const auto port =
        option != words.end() && option + 1 != words.end() ? parse_int(*(option + 1)) : std::nullopt;
    return static_cast<int>(port.value_or(SCREEN_PORT));
}

Result<std::string> select_in_browser(int port, bool opening) {
    constexpr auto LOOK = std::chrono::milliseconds(50), LOOK_AT_STEPS = std::chrono::milliseconds(10),
                   LAST_ANSWER = std::chrono::milliseconds(500);
    auto setup = make_setup();
    if (!setup.has_value()) {
        return std::unexpected(setup.error());
    }
    if (const auto found = check_screen(setup->screen_folder); !found.has_value()) {
        return std::unexpected(found.error());
    }
    auto server = screen::Server::listen({.port = port});
    if (!server.has_value()) {
        return std::unexpected(server.error());
    }
    const std::string address = fmt::format("http://127.0.0.1:{}/#key={}", (*server)->port(), setup->key);
    fmt::print("select a machine or create a new one: {}\n", address);
    std::fflush(stdout);
    screen::Worker disk([&server](std::function<void()> act) { (*server)->post(std::move(act)); });
    screen::FirstSteps page(disk, **server, std::move(*setup));
    Browser browser;
    if (opening) {
        browser.open(address);
    }
    std::int64_t end_ns = 0;
    while (stop_signal == 0 && (end_ns == 0 || now_ns() < end_ns)) {
        (*server)->run_for(page, page.isCommissioning() ? LOOK_AT_STEPS : LOOK);
        page.look();
        browser.look();
        if (page.chosen().has_value() && end_ns == 0) {
            end_ns = now_ns() + std::chrono::nanoseconds(LAST_ANSWER).count();
        }
    }
    page.end_steps();
    while (page.isCommissioning()) {
        (*server)->run_for(page, LOOK);
        page.look();
    }
    disk.end();
    if (!page.chosen().has_value()) {
        return std::string();
    }
    ::setenv(BROWSER_WAITS, "1", 1);
    return *page.chosen();
}

}  // namespace mw::programs
