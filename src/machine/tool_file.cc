// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/tool_file.hh"

#include <filesystem>

#include "base/atomic_file.hh"

namespace mw::machine {

Result<std::unique_ptr<task::ToolStore>> ToolFile::load(const std::string &path, diag::Sink &sink,
                                                        tool::Changer changer) {
    std::unique_ptr<ToolFile> file(new ToolFile(path, changer));
    std::error_code error;
    if (!path.empty() && !std::filesystem::exists(path, error)) {
        sink.warning("there is no tool table '" + path + "': it starts empty");
        return file;
    }
    const auto loaded = file->read(sink);
    if (!loaded.has_value()) {
        return std::unexpected(loaded.error());
    }
    return file;
}

Result<> ToolFile::reload() {
    diag::Sink sink;
    const Result<> done = read(sink);
    warnings_.clear();
    for (const diag::Diagnostic &one : sink.all()) {
        warnings_.insert(warnings_.begin(), one.what.str());
    }
    return done;
}

std::optional<std::string> ToolFile::take_warning() {
    if (warnings_.empty()) {
        return std::nullopt;
    }
    std::string text = std::move(warnings_.back());
    warnings_.pop_back();
    return text;
}

Result<> ToolFile::read(diag::Sink &sink) {
    if (path_.empty()) {
        return {};
    }
    const auto text = read_file(path_);
    if (!text.has_value()) {
        return std::unexpected(text.error());
    }
    const auto changer = isRandom() ? tool::Changer::RANDOM : tool::Changer::FIXED;
    replace(tool::Table::parse_leniently(*text, path_, sink, changer));
    return {};
}

Result<> ToolFile::load_spindle(int index) {
    const bool isMoved = isRandom() && index != 0;
    const Result<> done = ToolData::load_spindle(index);
    return done.has_value() && isMoved ? save() : done;
}

Result<> ToolFile::add(const interp::ToolEntry &entry) {
    tool::Table before = table();
    const Result<> added = ToolData::add(entry);
    const Result<> kept = added.has_value() ? save() : added;
    if (added.has_value() && !kept.has_value()) {
        restore(std::move(before));
    }
    return kept;
}

Result<> ToolFile::remove(int index) {
    tool::Table before = table();
    const Result<> removed = ToolData::remove(index);
    const Result<> kept = removed.has_value() ? save() : removed;
    if (removed.has_value() && !kept.has_value()) {
        restore(std::move(before));
    } else if (kept.has_value()) {
        forget_life(before.entry(index).toolno);
    }
    return kept;
}

Result<> ToolFile::set_entry(int index, const interp::ToolEntry &entry) {
    const bool isCopy = index == 0 && !isRandom();
    const Result<> done = ToolData::set_entry(index, entry);
    return done.has_value() && !isCopy ? save() : done;
}

}  // namespace mw::machine
