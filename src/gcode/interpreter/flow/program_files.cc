// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/interpreter/flow/program_files.hh"

#include <algorithm>
#include <filesystem>

namespace mw::gcode::detail {

Program *ProgramFiles::keep(std::unique_ptr<Program> program) {
    std::unique_ptr<Program> &place = files_[program->path()];
    place = std::move(program);
    return place.get();
}

Program *ProgramFiles::find_subroutine(std::string_view name, std::span<const std::string> folders,
                                       Names &names) {
    // A name that begins with a slash is also relative to the folder.
    name.remove_prefix(std::min(name.find_first_not_of('/'), name.size()));
    const std::string file = std::string(name) + ".ngc";
    for (const std::string &folder : folders) {
        const std::filesystem::path path = std::filesystem::path(folder) / file;
        if (const auto known = files_.find(path.string()); known != files_.end()) {
            return known->second.get();
        }
        std::error_code ignored;
        if (!std::filesystem::is_regular_file(path, ignored)) {
            continue;
        }
        if (Result<std::unique_ptr<Program>> loaded = Program::load(path.string(), names)) {
            return keep(std::move(*loaded));
        }
    }
    return nullptr;
}

std::string ProgramFiles::line_text(const std::string &file, int line) const {
    const auto found = files_.find(file);
    const bool present = found != files_.end() && line >= 1 && line <= found->second->count_lines();
    return present ? std::string(found->second->line_text(line)) : std::string();
}

Program *ProgramFiles::keep_mdi(std::string_view line, Names &names) {
    return mdi_.emplace_back(std::make_unique<Program>("MDI", std::string(line), names)).get();
}

Program *ProgramFiles::keep_script_text(std::string_view text, Names &names) {
    return texts_.emplace_back(std::make_unique<Program>("script", std::string(text), names)).get();
}

}  // namespace mw::gcode::detail
