// SPDX-License-Identifier: GPL-2.0-or-later
// A disk in memory whose power can be cut. Data that was not synced is lost as on a real disk.
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <random>
#include <string>

#include "machine/journal/disk.hh"

namespace mw::journal::test {

/// The surviving state. Names and contents are separate: a rename that was not synced may be undone, and a
/// file that was not synced may have any prefix of later writes, with random bytes in its last sector.
class TornDisk {
  public:
    static constexpr std::size_t SECTOR = 512;

    struct File {
        std::string now, synced;
    };
    using Id = std::uint64_t;
    std::map<Id, File> files;
    std::map<std::string, Id> names, synced_names;
    Id last = 0;
    /// Number of steps until the power fails; negative: it does not fail.
    long steps_left = -1;
    bool isDead = false;

    /// Counts a step. Returns true if the power has failed; later steps then have no effect.
    bool tick() {
        isDead = isDead || steps_left == 0;
        steps_left -= steps_left > 0 ? 1 : 0;
        return isDead;
    }

    void write_outside(const std::string &path, const std::string &content) {
        const Id id = ++last;
        files[id] = {content, content};
        names[path] = synced_names[path] = id;
    }

    void cut_power(std::mt19937_64 &random) {
        const auto chance = [&](unsigned of) { return random() % of == 0; };
        for (auto &[id, file] : files) {
            file.now = file.synced = torn(file, random);
        }
        // Each change of a name since the last sync of the folder may or may not have reached the disk.
        for (const auto &[path, id] : names) {
            if (!synced_names.contains(path) || synced_names[path] != id) {
                if (chance(2)) {
                    synced_names[path] = id;
                }
            }
        }
        for (auto it = synced_names.begin(); it != synced_names.end();) {
            it = !names.contains(it->first) && chance(2) ? synced_names.erase(it) : std::next(it);
        }
        names = synced_names;
        steps_left = -1;
        isDead = false;
    }

  private:
    static std::string torn(const File &file, std::mt19937_64 &random) {
        const bool appended = file.now.starts_with(file.synced);
        const std::size_t sure = appended ? file.synced.size() : 0;
        if (file.now == file.synced) {
            return file.now;
        }
        if (!appended && random() % 2 == 0) {
            return file.synced;
        }
        const std::size_t kept = sure + random() % (file.now.size() - sure + 1);
        std::string content = file.now.substr(0, kept);
        // The rest of the sector being written keeps its old bytes.
        const std::size_t end = std::min(file.now.size(), (kept + SECTOR - 1) / SECTOR * SECTOR);
        if (random() % 2 == 0) {
            while (content.size() < end) {
                content.push_back(static_cast<char>(random() % 3 == 0 ? random() : 0));
            }
        }
        return content;
    }
};

/// The disk as seen by a program.
class TornDiskView final : public Disk {
  public:
    explicit TornDiskView(TornDisk &disk) : disk_(disk) {}

    bool exists(const std::string &path) override { return disk_.names.contains(path); }
    Result<std::string> read(const std::string &path) override {
        return exists(path) ? Result<std::string>(disk_.files[disk_.names[path]].now) : fail("no " + path);
    }
    Result<> write_new(const std::string &path, std::string_view bytes) override {
        if (disk_.tick()) {
            return {};
        }
        if (!exists(path)) {
            disk_.names[path] = ++disk_.last;
        }
        disk_.files[disk_.names[path]].now = bytes;
        return {};
    }
    Result<> append(const std::string &path, std::string_view bytes) override {
        if (disk_.tick()) {
            return {};
        }
        if (!exists(path)) {
            return fail("no " + path);
        }
        disk_.files[disk_.names[path]].now += bytes;
        return {};
    }
    Result<> sync(const std::string &path) override {
        if (disk_.tick()) {
            return {};
        }
        TornDisk::File &file = disk_.files[disk_.names[path]];
        file.synced = file.now;
        return {};
    }
    Result<> rename(const std::string &from, const std::string &to) override {
        if (disk_.tick()) {
            return {};
        }
        disk_.names[to] = disk_.names[from];
        disk_.names.erase(from);
        return {};
    }
    Result<> remove(const std::string &path) override {
        if (!disk_.tick()) {
            disk_.names.erase(path);
        }
        return {};
    }
    Result<> sync_folder_of(const std::string &) override {
        if (!disk_.tick()) {
            disk_.synced_names = disk_.names;
        }
        return {};
    }

  private:
    TornDisk &disk_;
};

}  // namespace mw::journal::test
