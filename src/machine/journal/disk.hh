// SPDX-License-Identifier: GPL-2.0-or-later
// What the journal asks of a disk, step by step, so that tests can cut the power between any two of them.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "base/result.hh"

namespace mw::journal {

/// One thread at a time. Nothing is there for good before it is synced.
class Disk {
  public:
    virtual ~Disk() = default;
    virtual bool exists(const std::string &path) = 0;
    virtual Result<std::string> read(const std::string &path) = 0;
    /// A new file, or an old one without what it had.
    virtual Result<> write_new(const std::string &path, std::string_view bytes) = 0;
    virtual Result<> append(const std::string &path, std::string_view bytes) = 0;
    /// The content of a file is there for good afterwards.
    virtual Result<> sync(const std::string &path) = 0;
    virtual Result<> rename(const std::string &from, const std::string &to) = 0;
    virtual Result<> remove(const std::string &path) = 0;
    /// The names in the folder of a file are there for good afterwards.
    virtual Result<> sync_folder_of(const std::string &path) = 0;
    /// The old content or the new one, whatever happens meanwhile; a link stays one.
    virtual Result<> rewrite(const std::string &path, std::string_view bytes);
};

/// What becomes of the content that a file had.
enum class Old : std::uint8_t {
    DROPPED,
    BACKED_UP,  ///< is in the file's name with .bak
};

/// Of this computer.
std::unique_ptr<Disk> system_disk();

/// The old content or the new one, whatever happens meanwhile.
Result<> replace_file(Disk &disk, const std::string &path, std::string_view bytes);

/// As Disk::rewrite(), the old content first in the backup, by the rule of write_file_with_backup().
Result<> rewrite_with_backup(Disk &disk, const std::string &path, std::string_view bytes);

}  // namespace mw::journal
