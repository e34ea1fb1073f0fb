// SPDX-License-Identifier: GPL-2.0-or-later
#include "programs/setup/changed_machine.hh"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <set>

#include <fmt/format.h>

#include "base/atomic_file.hh"
#include "base/text.hh"
#include "machine/setup/files.hh"
#include "programs/setup/new_machine.hh"

namespace mw::programs {
namespace {

namespace fs = std::filesystem;
using setup::Side;

std::optional<std::string> text_of(const fs::path &path) {
    std::error_code error;
    if (!fs::is_regular_file(path, error)) {
        return std::nullopt;
    }
    auto text = read_file(path.string());
    return text.has_value() ? std::optional(std::move(*text)) : std::nullopt;
}

/// Names of the files of the last generation.
std::set<std::string> generated_names(const fs::path &folder) {
    std::set<std::string> names;
    std::error_code error;
    for (fs::recursive_directory_iterator entry(folder, error), end; !error && entry != end;
         entry.increment(error)) {
        if (entry->is_regular_file(error)) {
            names.insert(fs::relative(entry->path(), folder, error).string());
        }
    }
    return names;
}

struct Planned {
    FileChange change;
    std::string text;
};

class Changer {
  public:
    Changer(fs::path folder, std::vector<setup::File> files, Side side)
        : folder_(std::move(folder)), files_(std::move(files)), side_(side) {}

    void plan() {
        std::set<std::string> left = generated_names(folder_ / GENERATED_FOLDER);
        for (const setup::File &file : files_) {
            left.erase(file.name);
            plan_file(file);
        }
        for (const std::string &name : left) {
            plan_removal(name);
        }
    }
    MachineChange change() const {
        MachineChange change;
        for (const Planned &planned : planned_) {
            change.files.push_back(planned.change);
        }
        return change;
    }
    Result<> write() const {
        std::error_code error;
        for (const Planned &planned : planned_) {
            const fs::path path = folder_ / planned.change.name;
            if (planned.change.type == FileChange::Type::REMOVED) {
                fs::remove(path, error);
                fs::remove(folder_ / GENERATED_FOLDER / planned.change.name, error);
            } else if (planned.change.type != FileChange::Type::UNCHANGED) {
                fs::create_directories(path.parent_path(), error);
                if (auto written = write_file_with_backup(path.string(), planned.text); !written) {
                    return written;
                }
            }
        }
        return write_generated(folder_.string(), files_);
    }

  private:
    void plan_file(const setup::File &file) {
        const auto generated = text_of(folder_ / GENERATED_FOLDER / file.name);
        const auto edited = text_of(folder_ / file.name);
        FileChange change{.name = file.name, .type = FileChange::Type::UNCHANGED, .conflicts = {}};
        if (!generated.has_value() && !edited.has_value()) {
            change.type = FileChange::Type::CREATED;
            planned_.push_back({std::move(change), file.text});
            return;
        }
        // Without a record, all lines count as edited.
        setup::Merged merged = setup::merge(generated.value_or(""), edited.value_or(""), file.text, side_);
        change.conflicts = std::move(merged.conflicts);
        const bool same = edited.has_value() ? merged.text == *edited : merged.text.empty();
        change.type = same ? FileChange::Type::UNCHANGED : FileChange::Type::CHANGED;
        planned_.push_back({std::move(change), std::move(merged.text)});
    }
    void plan_removal(const std::string &name) {
        const auto generated = text_of(folder_ / GENERATED_FOLDER / name);
        const auto edited = text_of(folder_ / name);
        FileChange change{.name = name, .type = FileChange::Type::REMOVED, .conflicts = {}};
        if (edited.has_value() && edited != generated) {
            change.conflicts.push_back({1, generated.value_or(""), *edited, ""});
            change.type = side_ == Side::EDITED ? FileChange::Type::UNCHANGED : change.type;
        }
        planned_.push_back({std::move(change), ""});
    }

    fs::path folder_;
    std::vector<setup::File> files_;
    Side side_;
    std::vector<Planned> planned_;
};

/// Lines with a mark at their beginning.
std::string marked(const std::string &text, const char *mark) {
    std::string all;
    std::string_view rest = text;
    while (!rest.empty()) {
        const std::size_t end = std::min(rest.find('\n'), rest.size());
        all += fmt::format("    {} {}\n", mark, printable(rest.substr(0, end)));
        rest.remove_prefix(std::min(end + 1, rest.size()));
    }
    return all;
}

}  // namespace

Result<setup::Answers> recorded_answers(const std::string &folder) {
    const std::string path = (fs::path(folder) / ANSWERS_FILE).string();
    const auto text = read_file(path);
    if (!text.has_value()) {
        return fail("'" + folder + "' has no file " + ANSWERS_FILE + ": its answers are not known", {},
                    "only machines that millwright setup has written can be opened");
    }
    return read_answers(*text, path);
}

setup::Answers changed_answers(const setup::Answers &recorded, const setup::Answers &given) {
    setup::Answers all = recorded;
    for (const auto &[key, value] : given) {
        all[key] = value;
    }
    // Each round may change the next questions: first those of the board, then those of its terminals.
    constexpr int ROUNDS = 5;
    const auto before = setup::questions(recorded);
    for (int round = 0; round < ROUNDS; ++round) {
        const auto asked = setup::questions(all);
        setup::Answers kept;
        for (const auto &[key, value] : all) {
            const auto now = std::ranges::find(asked, key, &setup::Question::key);
            const auto then = std::ranges::find(before, key, &setup::Question::key);
            const bool is_asked = now != asked.end();
            const bool was_preset = then != before.end() && then->preset == value;
            const bool follows = is_asked && was_preset && now->preset != value;
            if (given.contains(key) || (is_asked && !follows)) {
                kept[key] = value;
            }
        }
        all = std::move(kept);
    }
    return all;
}

bool MachineChange::hasConflicts() const {
    return std::ranges::any_of(files, [](const FileChange &file) { return !file.conflicts.empty(); });
}

Result<MachineChange> change_machine(const std::string &folder, const setup::Plan &plan,
                                     const setup::Answers &given, ConflictRule rule) {
    Changer changer(folder, setup::machine_files(plan),
                    rule == ConflictRule::TAKE_NEW ? Side::WANTED : Side::EDITED);
    changer.plan();
    MachineChange change = changer.change();
    if (rule == ConflictRule::REPORT && change.hasConflicts()) {
        return change;
    }
    if (auto written = changer.write(); !written.has_value()) {
        return std::unexpected(written.error());
    }
    const fs::path answers = fs::path(folder) / ANSWERS_FILE;
    if (auto written = write_file_atomically(answers.string(), answers_text(given)); !written.has_value()) {
        return std::unexpected(written.error());
    }
    change.isWritten = true;
    return change;
}

std::string change_text(const MachineChange &change) {
    std::string text;
    for (const FileChange &file : change.files) {
        const char *const what = file.type == FileChange::Type::CHANGED   ? "changed"
                                 : file.type == FileChange::Type::CREATED ? "created"
                                 : file.type == FileChange::Type::REMOVED ? "removed"
                                                                          : "";
        if (*what != '\0') {
            text += fmt::format("{}: {}\n", file.name, what);
        }
        for (const setup::Conflict &conflict : file.conflicts) {
            text += fmt::format("{}:{}: conflict\n", file.name, conflict.line) +
                    marked(conflict.generated, "generated:") + marked(conflict.edited, "edited:   ") +
                    marked(conflict.wanted, "new:      ");
        }
    }
    return text;
}

}  // namespace mw::programs
