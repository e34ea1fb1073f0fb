// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/tool_file.hh"

#include <algorithm>
#include <filesystem>

#include "base/atomic_file.hh"

namespace mw::machine {

Result<std::unique_ptr<ToolFile>> ToolFile::load(const std::string &path, diag::Sink *sink) {
    std::unique_ptr<ToolFile> file(new ToolFile(path));
    diag::Sink silent;
    diag::Sink &told = sink != nullptr ? *sink : silent;
    std::error_code error;
    if (!path.empty() && !std::filesystem::exists(path, error)) {
        told.warning("there is no tool table '" + path + "': it starts empty");
        return file;
    }
    const auto loaded = file->reload(told);
    if (!loaded.has_value()) {
        return std::unexpected(loaded.error());
    }
    return file;
}

Result<> ToolFile::reload() {
    diag::Sink silent;
    return reload(silent);
}

Result<> ToolFile::reload(diag::Sink &sink) {
    if (path_.empty()) {
        return {};
    }
    const auto text = read_file(path_);
    if (!text.has_value()) {
        return std::unexpected(text.error());
    }
    tool::Table table = tool::Table::parse_leniently(*text, path_, sink);
    const int in_spindle = table_.entry(0).toolno;
    table_ = std::move(table);
    ++version_;
    table_.load_spindle(in_spindle > 0 ? std::max(0, table_.index_of_tool(in_spindle)) : 0);
    return {};
}

Result<> ToolFile::load_spindle(int index) {
    if (index < 0 || index >= table_.count()) {
        return fail("the tool table has no entry " + std::to_string(index));
    }
    table_.load_spindle(index);
    ++version_;
    return {};
}

Result<> ToolFile::set_entry(int index, const interp::ToolEntry &entry) {
    if (index < 0 || index >= table_.count()) {
        return fail("the tool table has no entry " + std::to_string(index));
    }
    table_.set_entry(index, entry);
    ++version_;
    return index == 0 || path_.empty() ? Result<>{} : table_.save(path_);
}

}  // namespace mw::machine
