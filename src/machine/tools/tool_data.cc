// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/tools/tool_data.hh"

#include <algorithm>
#include <filesystem>

#include "base/atomic_file.hh"
#include "machine/tools/tool_database.hh"
#include "machine/tools/tool_file.hh"

namespace mw::machine {

Result<> ToolData::load_spindle(int index) {
    if (index < 0 || index >= count()) {
        return fail("the tool table has no entry " + std::to_string(index));
    }
    save_life();
    table_.load_spindle(index);
    ++version_;
    return {};
}

void ToolData::keep_life(const std::string &path, journal::Writer &keeper, diagnostics::Sink &sink) {
    std::error_code missing;
    if (std::filesystem::exists(path, missing)) {
        const auto text = read_file(path);
        const auto read =
            text.has_value() ? tools::LifeBook::parse(*text, path) : std::unexpected(text.error());
        if (!read.has_value()) {
            sink.warning(read.error().message + ": tool life is not saved", read.error().place);
            return;
        }
        life_ = *read;
    }
    life_path_ = path;
    keeper_ = &keeper;
}

void ToolData::save_life() {
    if (unsaved_life_s_ != 0) {
        write_life();
    }
}

void ToolData::write_life() {
    if (life_path_.empty()) {
        return;
    }
    unsaved_life_s_ = 0;
    keeper_->keep_file(life_path_, life_.text());
}

void ToolData::note_cut(int toolno, const tools::CutLife &cut) {
    constexpr double MOST_UNSAVED_S = 60;
    if (cut.time_s <= 0) {
        return;
    }
    life_.add(toolno, cut);
    unsaved_life_s_ += cut.time_s;
    if (unsaved_life_s_ > MOST_UNSAVED_S) {
        save_life();
    }
}

Result<> ToolData::set_entry(int index, const gcode::ToolEntry &entry) {
    const bool is_copy = index == 0 && !isRandom();
    const bool present = index >= 0 && index < count();
    const bool same = present && (is_copy || table_.entry(index).toolno == entry.toolno);
    const int found = same ? index : table_.index_of_tool(entry.toolno);
    if (found < 0) {
        return fail("the tool table has no tool " + std::to_string(entry.toolno));
    }
    table_.set_entry(found, entry);
    ++version_;
    return {};
}

Result<> ToolData::add(const gcode::ToolEntry &entry) {
    const auto put = table_.put(entry);
    if (!put.has_value()) {
        return std::unexpected(put.error());
    }
    ++version_;
    return {};
}

Result<> ToolData::remove(int index) {
    const Result<> removed = table_.remove(index);
    version_ += removed.has_value() ? 1 : 0;
    return removed;
}

void ToolData::forget_life(int toolno) {
    if (life_.of(toolno).time_s > 0) {
        life_.forget(toolno);
        write_life();
    }
}

void ToolData::replace(tools::Table table) {
    const int in_spindle = table_.entry(0).toolno;
    table_ = std::move(table);
    if (!isRandom() && in_spindle > 0) {
        table_.load_spindle(std::max(0, table_.index_of_tool(in_spindle)));
    }
    ++version_;
}

namespace {

Result<std::unique_ptr<task::ToolStore>> open_kept(const MachineConfig &machine, diagnostics::Sink &sink,
                                                   const ToolOptions &options) {
    const auto changer = machine.is_random_toolchanger ? tools::Changer::RANDOM : tools::Changer::FIXED;
    journal::Writer *const keeper = options.awaited ? nullptr : options.keeper;
    if (!machine.tool_database.empty()) {
        return ToolDatabase::start(
            {machine.tool_database, machine.ini_folder, changer, options.awaited, keeper}, sink);
    }
    return ToolFile::load(machine.tool_table_file, sink, changer, keeper);
}

}  // namespace

Result<std::unique_ptr<task::ToolStore>> open_tools(const MachineConfig &machine, diagnostics::Sink &sink,
                                                    const ToolOptions &options) {
    auto made = open_kept(machine, sink, options);
    const bool has_place = !machine.tool_database.empty() || !machine.tool_table_file.empty();
    if (made.has_value() && options.keeper != nullptr && has_place) {
        const std::filesystem::path path = machine.tool_database.empty()
                                               ? std::filesystem::path(machine.tool_table_file + ".life")
                                               : std::filesystem::path(machine.ini_folder) / "tool.life";
        static_cast<ToolData &>(**made).keep_life(path.string(), *options.keeper, sink);
    }
    return made;
}

Result<std::unique_ptr<task::ToolStore>> read_tools(const MachineConfig &machine, diagnostics::Sink &sink) {
    const auto opened = open_tools(machine, sink);
    if (!opened.has_value()) {
        return std::unexpected(opened.error());
    }
    return std::make_unique<ToolData>(static_cast<const ToolData &>(**opened).table());
}

}  // namespace mw::machine
