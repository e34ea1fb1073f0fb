// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/interpreter/flow/sub_search.hh"

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

namespace mw::gcode::detail {
namespace {

/// True if the path of the name leads outside the folder.
bool leadsOut(std::string_view name) {
    const std::filesystem::path path(name);
    return std::find(path.begin(), path.end(), "..") != path.end();
}

Program *load_file(NameId label, const SubSearch &search) {
    if (search.confined && leadsOut(search.names.text(label))) {
        return nullptr;
    }
    std::vector<std::string> folders = search.folders;
    const Levels &levels = search.levels;
    if (!levels.isMdi() || levels.isInCall()) {
        folders.insert(folders.begin(), std::filesystem::path(levels.main()->path()).parent_path().string());
    }
    return search.files.find_subroutine(search.names.text(label), folders, search.names);
}

using FindLine = int (Program::*)(NameId label) const;

/// Searches the current file, its callers from the innermost, then a separate file.
bool look_up(NameId label, FindLine find_line, const SubSearch &search, Sub &sub) {
    const auto look_in = [&](Program *program) {
        sub = {program, program == nullptr ? 0 : (program->*find_line)(label)};
        return sub.line != 0;
    };
    bool found = look_in(search.levels.here().program);
    const std::span<const Call> calls = search.levels.calls();
    for (auto call = calls.rbegin(); call != calls.rend() && !found; ++call) {
        found = look_in(call->program);
    }
    return found || look_in(load_file(label, search));
}

/// True if the search reached the end of the main program and it ends with a percent sign.
bool isEndReached(const Levels &levels) {
    const Program *const main = levels.main();
    return !levels.isMdi() && main->isPercentDelimited() && main->hasClosingPercent();
}

}  // namespace

std::string called_from(NameId label, const Levels &levels, const Names &names) {
    const int line = levels.isInCall() ? levels.top().line : levels.here().line;
    return fmt::format("subroutine O{}, called in line {}", names.text(label), line);
}

bool find_sub(NameId label, std::uint32_t column, const SubSearch &search, Sub &sub) {
    if (look_up(label, &Program::find_sub, search, sub)) {
        return true;
    }
    Fault &fault = search.fault;
    if (Sub fanuc; look_up(label, &Program::find_fanuc, search, fanuc)) {
        fault.line = fanuc.program == search.levels.here().program ? fanuc.line : 0;
        return fault.set(FANUC_TEXT, 0, called_from(label, search.levels, search.names));
    }
    fault.program_ended = isEndReached(search.levels);
    return fault.set(
        fmt::format(
            "There is no subroutine o<{0}>: neither in this file nor as {0}.ngc in the subroutine path",
            search.names.text(label)),
        column);
}

bool find_fanuc_sub(NameId label, const SubSearch &search, Sub &sub) {
    if (look_up(label, &Program::find_fanuc, search, sub)) {
        return true;
    }
    Fault &fault = search.fault;
    if (const int other = search.levels.here().program->find_sub(label); other != 0) {
        fault.line = other;
        return fault.set(OWORD_TEXT, 0, called_from(label, search.levels, search.names));
    }
    fault.program_ended = isEndReached(search.levels);
    return fault.set(fmt::format("There is no subroutine O{} for this M98", search.names.text(label)));
}

}  // namespace mw::gcode::detail
