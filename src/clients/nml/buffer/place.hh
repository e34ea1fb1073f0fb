// SPDX-License-Identifier: GPL-2.0-or-later
// Where the memory of a buffer lies: shared, in this process, or in a file.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "base/result.hh"
#include "clients/nml/buffer/store.hh"

namespace mw::nml {

/// Keeps the memory as long as it is used.
class Place {
  public:
    Place(const StoreShape &shape, void *memory) : store(memory, shape) {}
    Place(const Place &) = delete;
    Place &operator=(const Place &) = delete;
    virtual ~Place() = default;
    /// Its owner is alive, or it needs none.
    virtual bool isKept() const { return true; }
    /// Others now know the process that has opened it.
    virtual void settle() {}

    Store store;
};

/// Buffers of kind LOCMEM, by name: one for a process. Any thread.
class LocalPlaces {
  public:
    /// The master makes it; others find it while it is in use.
    Result<std::shared_ptr<Place>> open(const BufferSettings &buffer, bool isMaster);

  private:
    std::mutex mutex_;
    std::map<std::string, std::weak_ptr<Place>> places_;
};

/// Memory that this user's processes share, by the instance of the machine and the buffer's key. The master
/// makes it and takes it away.
Result<std::shared_ptr<Place>> open_shared_place(const BufferSettings &buffer, const std::string &instance,
                                                 bool isMaster);

/// A file, which keeps the last message, and a queue, when it is not in use.
Result<std::shared_ptr<Place>> open_file_place(const BufferSettings &buffer, bool isMaster);

}  // namespace mw::nml
