// SPDX-License-Identifier: GPL-2.0-or-later
// A machine that starts, works and ends repeatedly leaves nothing behind: no file, descriptor, thread,
// process or shared memory. MILLWRIGHT_LIVES=N sets the number of runs.
#include <dirent.h>

#include <cstdlib>
#include <map>
#include <set>

#include "base/text.hh"
#include "sim/virtual_machine.hh"

#if defined(__SANITIZE_ADDRESS__)
#define MW_ADDRESS_SANITIZER 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define MW_ADDRESS_SANITIZER 1
#endif
#endif
#ifdef MW_ADDRESS_SANITIZER
#include <sanitizer/allocator_interface.h>
#endif

namespace mw::machine {
namespace {

using Names = std::set<std::string>;

Names names_in(const std::string &folder) {
    Names names;
    if (DIR *const dir = ::opendir(folder.c_str())) {
        while (const dirent *const entry = ::readdir(dir)) {
            names.insert(entry->d_name);
        }
        ::closedir(dir);
    }
    return names;
}

/// The resources that this process holds, and those that it may have created elsewhere.
std::map<std::string, std::size_t> held() {
    std::map<std::string, std::size_t> all;
    all["descriptors"] = names_in("/proc/self/fd").size();
    all["threads"] = names_in("/proc/self/task").size();
    std::ifstream children("/proc/self/task/" + std::to_string(::getpid()) + "/children");
    std::string child;
    while (children >> child) {
        ++all["children"];
    }
    std::ifstream maps("/proc/self/maps");
    for (std::string line; std::getline(maps, line);) {
        all["shared mappings"] +=
            line.find("/dev/shm/") != std::string::npos || line.find("/memfd:") != std::string::npos ? 1U
                                                                                                     : 0U;
    }
    return all;
}

/// Only of this process, because other tests run at the same time.
Names shared_memory() {
    Names ours;
    const std::string mark = std::to_string(::getpid());
    for (const std::string &name : names_in("/dev/shm")) {
        if (name.find(mark) != std::string::npos) {
            ours.insert(name);
        }
    }
    return ours;
}

#ifdef MW_ADDRESS_SANITIZER
/// Memory that has been allocated and not freed. The memory of the process does not show this, because freed
/// memory is kept for some time to detect its use.
long memory_kib() {
    return static_cast<long>(__sanitizer_get_current_allocated_bytes() / 1024);
}
#else
/// The memory used by the process.
long memory_kib() {
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);) {
        if (line.starts_with("VmRSS:")) {
            return static_cast<long>(parse_int(split_words(line)[1]).value_or(0));
        }
    }
    return 0;
}
#endif

class LifecycleTest : public VirtualMachineTest {
  protected:
    void live(int number) {
        switch_on();
        ASSERT_EQ(mdi("G0 X" + std::to_string(number % 50 + 1)), task::Progress::DONE);
        start("G21 G90 F3000\nG1 X0 Y5\nG2 X5 Y0 I0 J-5\nM2\n");
        if (number % 2 == 0) {
            ASSERT_EQ(finish(), task::Progress::DONE) << messages();
        } else {
            cycles(number % 400);  // some end in the middle of a program
        }
        samples_.clear();
        machine_.reset();
    }
};

TEST_F(LifecycleTest, NothingIsLeftBehindByManyLives) {
    const char *const wanted = std::getenv("MILLWRIGHT_LIVES");
    const int lives = wanted != nullptr ? std::atoi(wanted) : 20;
    constexpr int FIRST = 5;  // by then libraries are loaded and pools are filled
    for (int i = 0; i < FIRST; ++i) {
        live(i);
    }
    const auto before = held();
    const Names memory_before = shared_memory(), folder_before = names_in(folder_.string());
    const long kib_before = memory_kib();
    for (int i = 0; i < lives && !HasFatalFailure(); ++i) {
        live(i);
    }
    EXPECT_EQ(held(), before);
    EXPECT_EQ(shared_memory(), memory_before);
    EXPECT_EQ(names_in(folder_.string()), folder_before);
    constexpr long SLACK_KIB = 20000;
    EXPECT_GT(kib_before, 0);
    EXPECT_LT(memory_kib(), kib_before + SLACK_KIB) << "memory grows with each life";
    RecordProperty("lives", lives);
}

}  // namespace
}  // namespace mw::machine
