// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/tools/tool_file.hh"

#include <filesystem>
#include <mutex>
#include <utility>

#include "base/atomic_file.hh"

namespace mw::machine {

/// Data that the thread of the disk reads.
struct ToolFile::Reading {
    std::mutex mutex;
    std::optional<Result<tools::Table>> table;  ///< guarded by the mutex
    diagnostics::Sink sink;                     ///< used by that thread until there is a table
};

Result<std::unique_ptr<task::ToolStore>> ToolFile::load(const std::string &path, diagnostics::Sink &sink,
                                                        tools::Changer changer, journal::Writer *keeper) {
    std::unique_ptr<ToolFile> file(new ToolFile(path, changer, keeper));
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
    if (keeper_ != nullptr) {
        read_.reset();
        ask_for_text();
        return {};
    }
    diagnostics::Sink sink;
    const Result<> done = read(sink);
    keep_warnings(sink);
    read_ = done;
    return done;
}

void ToolFile::ask_for_text() {
    is_reading_old_ = false;
    reading_ = std::make_shared<Reading>();
    keeper_->read_file(
        path_, [reading = reading_, path = path_, changer = changer()](const Result<std::string> &text) {
            Result<tools::Table> table =
                text.has_value()
                    ? Result<tools::Table>(tools::Table::parse_leniently(*text, path, reading->sink, changer))
                    : std::unexpected(text.error());
            const std::lock_guard lock(reading->mutex);
            reading->table = std::move(table);
        });
}

void ToolFile::step() {
    if (reading_ == nullptr) {
        return;
    }
    {
        const std::lock_guard lock(reading_->mutex);
        if (!reading_->table.has_value()) {
            return;
        }
    }
    if (is_reading_old_) {
        ask_for_text();
        return;
    }
    const auto done = std::exchange(reading_, nullptr);
    if (done->table->has_value()) {
        replace(std::move(**done->table));
        keep_warnings(done->sink);
        read_ = Result<>{};
    } else {
        read_ = std::unexpected(done->table->error());
    }
}

void ToolFile::drop_reload() {
    if (std::exchange(reading_, nullptr) != nullptr) {
        read_ = fail("the tool table was not reloaded: the program was stopped");
    }
}

void ToolFile::keep_warnings(const diagnostics::Sink &sink) {
    warnings_.clear();
    for (const diagnostics::Diagnostic &one : sink.all()) {
        warnings_.insert(warnings_.begin(), one.what.str());
    }
}

std::optional<std::string> ToolFile::take_warning() {
    if (warnings_.empty()) {
        return std::nullopt;
    }
    std::string text = std::move(warnings_.back());
    warnings_.pop_back();
    return text;
}

Result<> ToolFile::read(diagnostics::Sink &sink) {
    if (path_.empty()) {
        return {};
    }
    const auto text = read_file(path_);
    if (!text.has_value()) {
        return std::unexpected(text.error());
    }
    replace(tools::Table::parse_leniently(*text, path_, sink, changer()));
    return {};
}

Result<> ToolFile::save() {
    if (path_.empty()) {
        return {};
    }
    is_reading_old_ = true;
    return keeper_ != nullptr ? keeper_->write_file(path_, table().text()) : table().save(path_);
}

Result<> ToolFile::keep() {
    if (keeper_ == nullptr) {
        return save();
    }
    is_reading_old_ = true;
    keeper_->keep_file(path_, table().text());
    return {};
}

Result<> ToolFile::save_or_restore(tools::Table before) {
    const Result<> saved = save();
    if (!saved.has_value()) {
        restore(std::move(before));
        if (keeper_ != nullptr) {
            // replaces the pending text, so that a disk that answers later does not write the change
            keeper_->keep_file(path_, table().text());
        }
    }
    return saved;
}

Result<> ToolFile::load_spindle(int index) {
    const bool moved = isRandom() && index != 0;
    const Result<> done = ToolData::load_spindle(index);
    return done.has_value() && moved ? keep() : done;
}

Result<> ToolFile::add(const gcode::ToolEntry &entry) {
    tools::Table before = table();
    const Result<> added = ToolData::add(entry);
    return added.has_value() ? save_or_restore(std::move(before)) : added;
}

Result<> ToolFile::remove(int index) {
    tools::Table before = table();
    const int toolno = index >= 0 && index < count() ? entry(index).toolno : 0;
    const Result<> removed = ToolData::remove(index);
    const Result<> saved = removed.has_value() ? save_or_restore(std::move(before)) : removed;
    if (saved.has_value()) {
        forget_life(toolno);
    }
    return saved;
}

Result<> ToolFile::set_entry(int index, const gcode::ToolEntry &entry) {
    const bool is_copy = index == 0 && !isRandom();
    const Result<> done = ToolData::set_entry(index, entry);
    return done.has_value() && !is_copy ? keep() : done;
}

}  // namespace mw::machine
