// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <latch>
#include <memory>
#include <string>

#include "machine/journal/disk.hh"

namespace mw::journal::test {

/// State shared by a test and its disk, which may outlive the test.
struct HungCalls {
    std::latch isCalled{1};    ///< the disk is in a call
    std::latch isReleased{1};  ///< set by the test to let the disk answer
    void wait() {
        if (!isCalled.try_wait()) {
            isCalled.count_down();
        }
        isReleased.wait();
    }
};

/// The disk of this computer, which answers only after the test releases it.
class HungDisk final : public Disk {
  public:
    explicit HungDisk(std::shared_ptr<HungCalls> calls) : calls_(std::move(calls)) {}
    bool exists(const std::string &path) override { return disk().exists(path); }
    Result<std::string> read(const std::string &path) override { return disk().read(path); }
    Result<> write_new(const std::string &path, std::string_view bytes) override {
        return disk().write_new(path, bytes);
    }
    Result<> append(const std::string &path, std::string_view bytes) override {
        return disk().append(path, bytes);
    }
    Result<> sync(const std::string &path) override { return disk().sync(path); }
    Result<> rename(const std::string &from, const std::string &to) override {
        return disk().rename(from, to);
    }
    Result<> remove(const std::string &path) override { return disk().remove(path); }
    Result<> sync_folder_of(const std::string &path) override { return disk().sync_folder_of(path); }
    Result<> rewrite(const std::string &path, std::string_view bytes) override {
        return disk().rewrite(path, bytes);
    }

  private:
    Disk &disk() {
        calls_->wait();
        return *disk_;
    }
    std::shared_ptr<HungCalls> calls_;
    std::unique_ptr<Disk> disk_ = system_disk();
};

}  // namespace mw::journal::test
