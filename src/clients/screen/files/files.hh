// SPDX-License-Identifier: GPL-2.0-or-later
// Access of a browser to the programs in [DISPLAY]PROGRAM_PREFIX (list, read, write, remove), and to the
// files of the screen.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.hh"
#include "base/temporary_file.hh"
#include "clients/screen/http/http_types.hh"

namespace mw::screen {

/// Blocks during disk access. One thread at a time.
class ProgramFiles {
  public:
    /// Maximum size of a program. [bytes]
    static constexpr std::uint64_t MOST_BYTES = 2ULL * 1024 * 1024 * 1024;
    static constexpr std::size_t MOST_UPLOADS = 8;

    /// Only files with one of `extensions` (lower case, with the dot) are accessible. Removes the files of
    /// uploads whose server has died.
    ProgramFiles(std::string folder, std::vector<std::string> extensions);
    /// Removes incomplete uploads.
    ~ProgramFiles() = default;
    ProgramFiles(const ProgramFiles &) = delete;
    ProgramFiles &operator=(const ProgramFiles &) = delete;

    Response list() const;
    /// `made` is the path of the program that a filter has created from the file; it is read instead.
    Response read(const std::string &name, const std::optional<std::string> &made = {}) const;
    /// The version that the last write has replaced.
    Response read_former(const std::string &name) const;
    /// Writes a piece of a file of `size` bytes at its offset. Pieces arrive in order; the first piece starts
    /// again. With the last piece the file is renamed to its name, completely or not at all. A replaced file
    /// with another content is kept as NAME~.
    Response write(const std::string &name, std::uint64_t offset, std::uint64_t size, std::string_view piece);
    Response remove(const std::string &name);

    /// Path of a program; an error if the name is not valid.
    Result<std::string> path_of(const std::string &name) const;

  private:
    struct Upload {
        TemporaryFile file;
        std::uint64_t at, size;
        std::uint64_t begun;  ///< identifies the upload
    };
    Response begin(const std::string &name, const std::string &path, std::uint64_t size);
    Response finish(const std::string &name, const std::string &path);

    std::string folder_;
    std::vector<std::string> extensions_;
    std::map<std::string, Upload> uploads_;  ///< uploads by name
    std::uint64_t begun_ = 0;
};

/// A file of the screen: "/" is index.html, other paths are files below `folder`. Other files are not
/// accessible.
Response screen_file(const std::string &folder, const std::string &path);

}  // namespace mw::screen
