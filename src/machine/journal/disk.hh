// SPDX-License-Identifier: GPL-2.0-or-later
// The disk operations of the journal, step by step, so that tests can cut the power between any two of them.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "base/result.hh"

namespace mw::journal {

/// One thread at a time. Changes are durable only after a sync.
class Disk {
  public:
    virtual ~Disk() = default;
    virtual bool exists(const std::string &path) = 0;
    virtual Result<std::string> read(const std::string &path) = 0;
    /// Writes a new file, or replaces the content of an old one.
    virtual Result<> write_new(const std::string &path, std::string_view bytes) = 0;
    virtual Result<> append(const std::string &path, std::string_view bytes) = 0;
    /// Makes the content of a file durable.
    virtual Result<> sync(const std::string &path) = 0;
    virtual Result<> rename(const std::string &from, const std::string &to) = 0;
    virtual Result<> remove(const std::string &path) = 0;
    /// Makes the names in the folder of a file durable.
    virtual Result<> sync_folder_of(const std::string &path) = 0;
    /// Replaces the content atomically. A symbolic link is kept.
    virtual Result<> rewrite(const std::string &path, std::string_view bytes);
};

/// Treatment of the old content of a file.
enum class Old : std::uint8_t {
    DROPPED,
    BACKED_UP,  ///< is copied to a file with the extension .bak
};

/// The disk of this computer.
std::unique_ptr<Disk> system_disk();

/// Replaces the content atomically.
Result<> replace_file(Disk &disk, const std::string &path, std::string_view bytes);

/// As Disk::rewrite(), with the old content in the backup, by the rules of write_file_with_backup().
Result<> rewrite_with_backup(Disk &disk, const std::string &path, std::string_view bytes);

}  // namespace mw::journal
