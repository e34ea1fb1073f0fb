// SPDX-License-Identifier: GPL-2.0-or-later
// Runs our programs as processes, each in a separate instance and folder.
#pragma once

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/atomic_file.hh"
#include "hal/host/host_client.hh"

namespace mw::hal::tools {

struct Ended {
    int status = -1;
    std::string out;
    std::string err;
};

class Programs : public ::testing::Test {
  protected:
    Programs() {
        folder = std::filesystem::temp_directory_path() / ("mw-halrun-" + std::to_string(getpid()));
        std::filesystem::create_directories(folder);
        instance = "tools-test-" + std::to_string(getpid());
        setenv("MILLWRIGHT_INSTANCE", instance.c_str(), 1);
        const std::string bin = MW_TEST_BIN;
        setenv("PATH", (bin + ":" + bin + "/../test/bin:/usr/bin:/bin").c_str(), 1);
    }
    ~Programs() override {
        EXPECT_FALSE(isHostAlive(instance)) << "a realtime process was left behind";
        std::filesystem::remove_all(folder);
    }

    std::string file(const std::string &name, const std::string &text) {
        const std::string path = (folder / name).string();
        std::ofstream(path) << text;
        return path;
    }

    pid_t start(const std::vector<std::string> &words) {
        const pid_t pid = fork();
        if (pid == 0) {
            const std::string out = (folder / "out").string();
            const std::string err = (folder / "err").string();
            dup2(open("/dev/null", O_RDONLY), 0);
            dup2(open(out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), 1);
            dup2(open(err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), 2);
            if (chdir(folder.c_str()) != 0) {
                _exit(126);
            }
            std::vector<char *> argv;
            for (const std::string &word : words) {
                argv.push_back(const_cast<char *>(word.c_str()));
            }
            argv.push_back(nullptr);
            execvp(argv[0], argv.data());
            _exit(127);
        }
        return pid;
    }

    Ended wait(pid_t pid) {
        int status = 0;
        waitpid(pid, &status, 0);
        Ended ended;
        ended.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
        ended.out = read_file((folder / "out").string()).value_or("");
        ended.err = read_file((folder / "err").string()).value_or("");
        return ended;
    }

    Ended run(const std::vector<std::string> &words) { return wait(start(words)); }

    std::filesystem::path folder;
    std::string instance;
};

}  // namespace mw::hal::tools
