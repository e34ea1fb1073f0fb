// SPDX-License-Identifier: GPL-2.0-or-later
// The programs in [DISPLAY]PROGRAM_PREFIX as a browser lists, reads, writes and removes them, and the files
// of the screen itself.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.hh"
#include "base/temporary_file.hh"
#include "clients/screen/http_types.hh"

namespace mw::screen {

/// Blocks while the disk does. One thread at a time.
class ProgramFiles {
  public:
    /// Largest program. [bytes]
    static constexpr std::uint64_t MOST_BYTES = 2ULL * 1024 * 1024 * 1024;
    static constexpr std::size_t MOST_UPLOADS = 8;

    /// Files that end in none of `extensions` (in lower case, with the dot) are not there. Removes the files
    /// of uploads whose server has died.
    ProgramFiles(std::string folder, std::vector<std::string> extensions);
    /// Removes the uploads that are not complete.
    ~ProgramFiles() = default;
    ProgramFiles(const ProgramFiles &) = delete;
    ProgramFiles &operator=(const ProgramFiles &) = delete;

    Response list() const;
    /// `made`: path of the program that a filter has made of it, which is read instead.
    Response read(const std::string &name, const std::optional<std::string> &made = {}) const;
    /// The version that the last write has replaced.
    Response read_former(const std::string &name) const;
    /// A piece of a file of `size` bytes at its place. Pieces come in their order; the first one begins
    /// again. With the last one the file gets its name, as a whole or not at all. A file that it replaces by
    /// another content is kept as NAME~.
    Response write(const std::string &name, std::uint64_t offset, std::uint64_t size, std::string_view piece);
    Response remove(const std::string &name);

    /// Where it lies; an error when it is no name of a program.
    Result<std::string> path_of(const std::string &name) const;

  private:
    struct Upload {
        TemporaryFile file;
        std::uint64_t at, size;
        std::uint64_t begun;  ///< which upload it is
    };
    Response begin(const std::string &name, const std::string &path, std::uint64_t size);
    Response finish(const std::string &name, const std::string &path);

    std::string folder_;
    std::vector<std::string> extensions_;
    std::map<std::string, Upload> uploads_;  ///< by name
    std::uint64_t begun_ = 0;
};

/// Of the screen: "/" is index.html, other paths are files below `folder`; nothing else is reached.
Response screen_file(const std::string &folder, const std::string &path);

}  // namespace mw::screen
