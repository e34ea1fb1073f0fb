// SPDX-License-Identifier: GPL-2.0-or-later
// Generates docs/reference/states.md from the tables that task uses.
#include <array>
#include <map>
#include <vector>

#include <fmt/format.h>

#include "machine/task/run/admission.hh"

namespace mw::task {
namespace {

struct Named {
    const char *name;
    const char *doc;
};

constexpr std::array<Named, static_cast<std::size_t>(Situation::COUNT)> SITUATIONS{{
    {"estop", "emergency stop"},
    {"off", "the emergency stop is reset, the machine is not on"},
    {"manual", "on, in manual mode"},
    {"auto", "on, in auto mode; nothing runs"},
    {"running", "a program is read, cut or stepped, waits, or its start is calculated"},
    {"held", "a program is paused by the operator, M0, M1 or M60"},
    {"proposed", "an approach is proposed and waits for its confirmation"},
    {"away", "the axes of a held program are released"},
    {"mdi", "on, in MDI mode; nothing runs"},
    {"line", "a line of MDI runs"},
    {"line held", "a line of MDI is paused"},
}};

constexpr std::array<Named, static_cast<std::size_t>(CommandClass::COUNT)> CLASSES{{
    {"at any time", "stops, messages, overrides, what ends something"},
    {"mode", "changes the mode (the active one is always accepted)"},
    {"program file", "which program is open, and what the interpreter is set to"},
    {"run", "begins a program"},
    {"step", "one block"},
    {"pause", "holds what runs"},
    {"resume", "continues after a pause; when an approach is proposed it confirms it"},
    {"turn", "backwards along the path, and forwards again"},
    {"line", "one line of MDI; while one runs it waits behind it"},
    {"jog", "moves by hand"},
    {"teleop", "whether moves by hand are those of axes or of joints"},
    {"joints", "homing, limits and homing parameters of joints"},
    {"unhome", "forgets where joints are"},
    {"energise", "starts a spindle or coolant"},
    {"tool table", "reads it again"},
    {"screw table", "is set while the machine is off"},
    {"confirm", "makes the approach that is proposed"},
    {"release", "lets the axes of a held program be jogged"},
    {"of the mailbox", "the right to operate, which the mailbox keeps"},
}};

/// Numbers the reasons of rejections in the order of their first use.
class Notes {
  public:
    std::string mark(const char *refusal) {
        if (refusal == nullptr) {
            return "yes";
        }
        const auto [found, isNew] = numbers_.try_emplace(refusal, texts_.size() + 1);
        if (isNew) {
            texts_.emplace_back(refusal);
        }
        return fmt::format("{}", found->second);
    }
    std::string list() const {
        std::string all;
        for (std::size_t i = 0; i < texts_.size(); ++i) {
            all += fmt::format("{}. {}\n", i + 1, texts_[i]);
        }
        return all;
    }

  private:
    std::map<std::string, std::size_t> numbers_;
    std::vector<std::string> texts_;
};

std::string rule(std::size_t columns) {
    std::string text = "|";
    for (std::size_t i = 0; i < columns; ++i) {
        text += "---|";
    }
    return text + "\n";
}

template <class... Commands>
std::array<std::string, CLASSES.size()> commands_by_class(std::type_identity<std::variant<Commands...>>) {
    std::array<std::string, CLASSES.size()> names;
    const auto add = [&](CommandClass what, const char *name) {
        std::string &list = names[static_cast<std::size_t>(what)];
        list += (list.empty() ? "" : ", ") + std::string(name);
    };
    (add(class_of<Commands>(), messages::DECLARATION<Commands>.name), ...);
    return names;
}

std::string admission() {
    std::string text = "| |";
    for (const Named &situation : SITUATIONS) {
        text += fmt::format(" {} |", situation.name);
    }
    text += "\n" + rule(SITUATIONS.size() + 1);
    Notes notes;
    for (std::size_t what = 0; what < CLASSES.size(); ++what) {
        text += fmt::format("| {} |", CLASSES[what].name);
        for (std::size_t where = 0; where < SITUATIONS.size(); ++where) {
            text += fmt::format(" {} |", notes.mark(refusal_of(static_cast<CommandClass>(what),
                                                               static_cast<Situation>(where))));
        }
        text += "\n";
    }
    return text + "\n" + notes.list();
}

template <class State>
std::string transitions() {
    constexpr auto STATES = static_cast<std::size_t>(State::COUNT);
    std::string text = "| |";
    for (std::size_t from = 0; from < STATES; ++from) {
        text += fmt::format(" {} |", name_of(static_cast<State>(from)));
    }
    text += "\n" + rule(STATES + 1);
    Notes notes;
    for (int event = 0; event < static_cast<int>(RunEvent::COUNT); ++event) {
        text += fmt::format("| {} |", name_of(static_cast<RunEvent>(event)));
        for (std::size_t from = 0; from < STATES; ++from) {
            const auto to = transition(static_cast<RunEvent>(event), static_cast<State>(from));
            text += to.refusal != nullptr               ? fmt::format(" {} |", notes.mark(to.refusal))
                    : to.to == static_cast<State>(from) ? " - |"
                                                        : fmt::format(" {} |", name_of(to.to));
        }
        text += "\n";
    }
    return text + "\n" + notes.list();
}

}  // namespace

std::string states_page() {
    std::string text =
        "# Commands and states\n\n"
        "This page shows which commands task accepts in which state, for authors of clients. Generated from "
        "the tables in `src/machine/task/run/admission.cc` and "
        "`src/machine/task/run/run_state.cc`.\n\n"
        "Task first checks each command with this table. *yes*: the command is passed to its handler, which "
        "may "
        "reject it for other\nreasons (a spindle that does not exist, joints that are not homed, a limit). A "
        "number refers to the reason of the rejection.\n\n## Situations\n\n| situation | the machine "
        "|\n|---|---|\n";
    for (const Named &situation : SITUATIONS) {
        text += fmt::format("| {} | {} |\n", situation.name, situation.doc);
    }
    text += "\n## Commands\n\n| class | effect | commands |\n|---|---|---|\n";
    const auto names = commands_by_class(std::type_identity<messages::CommandVariant>{});
    for (std::size_t i = 0; i < CLASSES.size(); ++i) {
        text += fmt::format("| {} | {} | {} |\n", CLASSES[i].name, CLASSES[i].doc, names[i]);
    }
    text += "\n## Commands in situations\n\n" + admission();
    text += "\n## Phases of a run\n\nRows are events, columns the phase before the event. `-`: no change. A "
            "number "
            "refers to the reason why the event is not possible.\n\n" +
            transitions<RunPhase>();
    return text + "\n## Pauses of a run\n\nRows are events, columns the pause before the event.\n\n" +
           transitions<Hold>();
}

}  // namespace mw::task
