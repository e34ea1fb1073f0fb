// SPDX-License-Identifier: GPL-2.0-or-later
// The memory of a buffer: shared, in this process, or in a file.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "base/result.hh"
#include "clients/nml/buffer/store.hh"

namespace mw::nml {

/// Keeps the memory while it is used.
class Place {
  public:
    Place(const StoreShape &shape, void *memory) : store(memory, shape) {}
    Place(const Place &) = delete;
    Place &operator=(const Place &) = delete;
    virtual ~Place() = default;
    /// True if its owner is alive, or it needs no owner.
    virtual bool isKept() const { return true; }
    /// Called when other processes know the process that has opened it.
    virtual void settle() {}

    Store store;
};

/// Buffers of type LOCMEM by name, one per process. Any thread.
class LocalPlaces {
  public:
    /// The master creates the memory; other users find it while it is in use.
    Result<std::shared_ptr<Place>> open(const BufferSettings &buffer, bool isMaster);

  private:
    std::mutex mutex_;
    std::map<std::string, std::weak_ptr<Place>> places_;
};

/// Memory shared by this user's processes, identified by the instance of the machine and the buffer's key.
/// The master creates and removes it.
Result<std::shared_ptr<Place>> open_shared_place(const BufferSettings &buffer, const std::string &instance,
                                                 bool isMaster);

/// A file, which keeps the last message or the queue while it is not in use.
Result<std::shared_ptr<Place>> open_file_place(const BufferSettings &buffer, bool isMaster);

}  // namespace mw::nml
