// SPDX-License-Identifier: GPL-2.0-or-later
#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "clients/nml/config/config_file.hh"

namespace mw::nml {
namespace {

struct Parsed {
    Config config;
    std::vector<std::string> told;
};

Parsed parse(std::string_view text) {
    diagnostics::Sink sink;
    Parsed parsed{parse_config(text, "m.nml", sink), {}};
    for (const diagnostics::Diagnostic &diagnostic : sink.all()) {
        const bool is_error = diagnostic.severity == diagnostics::Severity::ERROR;
        parsed.told.push_back((is_error ? "E " : "W ") + diagnostic.what.str());
    }
    return parsed;
}

/// The only message reported about `text`.
std::string told(std::string_view text) {
    const Parsed parsed = parse(text);
    return parsed.told.size() == 1 ? parsed.told[0] : std::to_string(parsed.told.size()) + " things told";
}

constexpr std::string_view COMMAND = "B emcCommand SHMEM localhost 8192 0 0 1 16 1001 ";

TEST(NmlConfig, ABufferLineIsReadWithEachFieldOnce) {
    const Parsed parsed = parse("# Buffers\n\n"
                                "B emcStatus\tSHMEM  10.0.0.7 20480 1 7 2 16 0x3EA TCP=5005 xdr\r\n");
    ASSERT_EQ(parsed.told, std::vector<std::string>{});
    ASSERT_EQ(parsed.config.buffers.size(), 1U);
    const BufferSettings &b = parsed.config.buffers[0];
    EXPECT_EQ(b.name, "emcStatus");
    EXPECT_EQ(b.kind, BufferKind::SHMEM);
    EXPECT_EQ(b.host, "10.0.0.7");
    EXPECT_EQ(b.size, 20480U);
    EXPECT_TRUE(b.neutral);
    EXPECT_EQ(b.rpc_number, 7);
    EXPECT_EQ(b.buffer_number, 2);
    EXPECT_EQ(b.max_processes, 16);
    EXPECT_EQ(b.key, 1002);
    EXPECT_EQ(b.tcp_port, 5005);
    EXPECT_EQ(b.encoding, Encoding::XDR);
    EXPECT_EQ(b.place.line, 3);
    EXPECT_EQ(b.mutex, Mutex::OS_SEM) << "the default";
    EXPECT_FALSE(b.is_queue || b.diagnosed || b.write_confirmed || b.isNumbered);
    EXPECT_TRUE(b.isBlockingAllowed());
}

TEST(NmlConfig, EveryDocumentedOptionHasItsMeaning) {
    const auto with = [](const std::string &options) {
        Parsed parsed = parse(std::string(COMMAND) + options);
        EXPECT_EQ(parsed.told, std::vector<std::string>{}) << options;
        return parsed.config.buffers.empty() ? BufferSettings{} : parsed.config.buffers[0];
    };
    EXPECT_EQ(with("mutex=none").mutex, Mutex::NONE);
    EXPECT_EQ(with("mutex=os_sem").mutex, Mutex::OS_SEM);
    EXPECT_EQ(with("mutex=mao split").mutex, Mutex::MAO) << "as the manual writes it";
    EXPECT_EQ(with("mutex=mao split").copies, 2);
    EXPECT_EQ(with("mutex=mao split=4").copies, 4);
    EXPECT_EQ(with("UDP=5006").udp_port, 5006);
    EXPECT_EQ(with("STCP=5007").stcp_port, 5007);
    EXPECT_EQ(with("tcp=5005").tcp_port, 5005);
    EXPECT_EQ(with("passwd=a.pwd").password_file, "a.pwd");
    EXPECT_FALSE(with("bsem=-1").isBlockingAllowed());
    EXPECT_EQ(with("bsem=1010").blocking_key, 1010);
    EXPECT_TRUE(with("bsem=1010").isBlockingAllowed());
    EXPECT_TRUE(with("queue").is_queue);
    EXPECT_EQ(with("ascii").encoding, Encoding::ASCII);
    EXPECT_EQ(with("disp").encoding, Encoding::DISPLAY);
    EXPECT_TRUE(with("diag").diagnosed);
    EXPECT_TRUE(with("confirm_write").write_confirmed);
    EXPECT_TRUE(with("serial").isNumbered);
    EXPECT_EQ(with("file=/tmp/x").file, "/tmp/x");
}

TEST(NmlConfig, AProcessLineIsReadWithEachFieldOnce) {
    const Parsed parsed = parse(std::string(COMMAND) + "\nP emcsvr emcCommand LOCAL localhost W 1 1.5 1 2\n"
                                                       "P xemc emcCommand REMOTE 10.0.0.7 rw 0 INF 0 10\n");
    ASSERT_EQ(parsed.told, std::vector<std::string>{});
    ASSERT_EQ(parsed.config.processes.size(), 2U);
    const ProcessSettings &server = parsed.config.processes[0], &client = parsed.config.processes[1];
    EXPECT_EQ(server.name, "emcsvr");
    EXPECT_EQ(server.buffer, "emcCommand");
    EXPECT_FALSE(server.isRemote || server.mayRead);
    EXPECT_TRUE(server.mayWrite && server.is_server && server.isMaster);
    EXPECT_EQ(server.timeout.seconds, 1.5);
    EXPECT_EQ(server.connection_number, 2);
    EXPECT_TRUE(client.isRemote && client.mayRead && client.mayWrite);
    EXPECT_EQ(client.host, "10.0.0.7");
    EXPECT_TRUE(client.timeout.isForever());
    EXPECT_FALSE(client.is_server || client.isMaster);
}

TEST(NmlConfig, TimeoutsAreAsTheManualSays) {
    const auto read = [](const std::string &word) {
        const Parsed parsed = parse(std::string(COMMAND) + "\nP p emcCommand LOCAL h R 0 " + word + " 0 0\n");
        EXPECT_EQ(parsed.config.processes.size(), 1U) << word;
        return parsed.config.processes.empty() ? Timeout{} : parsed.config.processes[0].timeout;
    };
    EXPECT_EQ(read("10.0").seconds, 10.0);
    EXPECT_TRUE(read("0").isAtOnce());
    EXPECT_TRUE(read("-1").isForever());
    EXPECT_TRUE(read("inf").isForever());
    EXPECT_FALSE(read("0.001").isForever() || read("0.001").isAtOnce());
}

TEST(NmlConfig, AProcessWithoutALineForABufferHasThatOfDefault) {
    const Config config = parse(std::string(COMMAND) + "\nB toolCmd SHMEM localhost 1024 0 0 4 16 1004\n"
                                                       "P emcsvr emcCommand LOCAL localhost W 1 1.0 1 2\n"
                                                       "P emcsvr default LOCAL localhost RW 1 1.0 1 2\n")
                              .config;
    ASSERT_NE(config.find_process("emcsvr", "toolCmd"), nullptr);
    EXPECT_TRUE(config.find_process("emcsvr", "toolCmd")->mayRead);
    EXPECT_FALSE(config.find_process("emcsvr", "emcCommand")->mayRead);
    EXPECT_EQ(config.find_process("xemc", "toolCmd"), nullptr);
    EXPECT_EQ(config.find_buffer("nobody"), nullptr);
}

TEST(NmlConfig, AWrongLineIsOneErrorWithFileLineAndField) {
    EXPECT_EQ(told("Q x"), "E m.nml:1:1: a line begins with B (buffer), P (process) or #, not with 'Q'");
    EXPECT_EQ(told("\nB a SHMEM h 10"),
              "E m.nml:2:15: field 'neut' is missing: the line has 4 of 9 (B name type host size neut RPC# "
              "buffer# max_procs key [options])");
    EXPECT_EQ(told("B a SHRAM h 10 0 0 1 1 1"),
              "E m.nml:1:5: field 'type': 'SHRAM' is not one of SHMEM, LOCMEM, FILEMEM, PHANTOM, GLOBMEM");
    EXPECT_EQ(told("B a SHMEM h 1k 0 0 1 1 1"),
              "E m.nml:1:13: field 'size': '1k' is not a whole number from 1 to 67108864");
    EXPECT_EQ(told("B a SHMEM h -1 0 0 1 1 1"),
              "E m.nml:1:13: field 'size': '-1' is not a whole number from 1 to 67108864");
    EXPECT_EQ(told("B a SHMEM h 10 2 0 1 1 1"), "E m.nml:1:16: field 'neut': '2' is not 0 or 1");
    EXPECT_EQ(told("B a SHMEM h 10 0 0 1 0 1"),
              "E m.nml:1:22: field 'max_procs': '0' is not a whole number from 1 to 256");
    EXPECT_EQ(told("B a SHMEM h 10 0 0 1 1 1 TCP=99999"),
              "E m.nml:1:26: option 'TCP': '99999' is not a whole number from 1 to 65535");
    EXPECT_EQ(told("B a SHMEM h 10 0 0 1 1 1 TCP"), "E m.nml:1:26: option 'TCP' needs a value: NAME=VALUE");
    EXPECT_EQ(told("B a SHMEM h 10 0 0 1 1 1 queue=3"), "E m.nml:1:26: option 'queue' has no value");
    EXPECT_EQ(told("B a SHMEM h 10 0 0 1 1 1 xdr ascii"),
              "E m.nml:1:30: option 'ascii': the buffer is xdr already");
    EXPECT_EQ(
        told("B a SHMEM h 10 0 0 1 1 1 mutex=mine"),
        "E m.nml:1:26: option 'mutex': 'mine' is not one of os_sem, none, no_interrupts, no_switching, mao");
    EXPECT_EQ(told("P p a LOCAL h X 0 1 0 0\nB a SHMEM h 10 0 0 1 1 1"),
              "E m.nml:1:15: field 'ops': 'X' is not one of R, W, RW");
    EXPECT_EQ(told("P p a LOCAL h R 0 soon 0 0\nB a SHMEM h 10 0 0 1 1 1"),
              "E m.nml:1:19: field 'timeout': 'soon' is neither a number of seconds nor INF");
    EXPECT_EQ(told(std::string("B a\x01 SHMEM h 10 0 0 1 1 1")),
              "E m.nml:1:3: the line has a control character");
}

TEST(NmlConfig, SeveralWrongFieldsAreToldInOneRunAndGoodLinesStay) {
    const Parsed parsed = parse("B a SHRAM h 1k 0 0 1 1 1\n" + std::string(COMMAND) + "\nB c\n");
    EXPECT_EQ(parsed.told.size(), 3U);
    ASSERT_EQ(parsed.config.buffers.size(), 1U);
    EXPECT_EQ(parsed.config.buffers[0].name, "emcCommand");
}

TEST(NmlConfig, LinesThatContradictEachOtherAreErrors) {
    const std::string a = "B a SHMEM h 10 0 0 1 4 1 TCP=5005\n";
    EXPECT_EQ(told(a + "B a SHMEM h 10 0 0 2 1 2\n"), "E m.nml:2:1: buffer 'a' is there already, in line 1");
    EXPECT_EQ(told(a + "B b SHMEM h 10 0 0 2 1 1\n"),
              "E m.nml:2:1: key 1 is that of buffer 'a' in line 1: both would be one memory");
    EXPECT_EQ(told(a + "B b SHMEM h 10 0 0 1 1 2 TCP=5005\n"),
              "E m.nml:2:1: buffer# 1 is that of buffer 'a' in line 1, which has the same port");
    EXPECT_EQ(told(a + "P p a LOCAL h R 0 1 0 4\n"),
              "E m.nml:2:1: field 'c_num': 4 is not below the 4 processes of buffer 'a'");
    EXPECT_EQ(told(a + "P p a LOCAL h R 0 1 0 1\nP p a LOCAL h W 0 1 0 1\n"),
              "E m.nml:3:1: process 'p' has a line for buffer 'a' already");
    EXPECT_EQ(told("B default SHMEM h 10 0 0 1 4 1"),
              "E m.nml:1:3: field 'name': no buffer may be called so");
}

TEST(NmlConfig, WhatDoesNothingIsToldAndNoError) {
    EXPECT_EQ(told("B a SHMEM h 10 0 0 1 1 1 quene"),
              "W m.nml:1:26: option 'quene' is unknown and does nothing (did you mean 'queue'?)");
    EXPECT_EQ(told("P p a LOCAL h R 0 1 0 0"),
              "W m.nml:1:1: process 'p': there is no buffer 'a'; the line does nothing");
    EXPECT_EQ(told("B a SHMEM h 10 0 0 1 1 1 mutex=no_switching"),
              "W m.nml:1:1: buffer 'a': Linux has no such mutex; it is used as mutex=os_sem");
    EXPECT_EQ(
        told("B a SHMEM h 10 0 0 1 1 1 serialPortDevName=/dev/ttyS0"),
        "W m.nml:1:1: buffer 'a': messages do not go over serial lines; the option does nothing (use TCP=)");
    EXPECT_EQ(
        told("B a SHMEM h 10 0 0 1 1 1\nP p a LOCAL h R 0 1 0 0 xdr"),
        "W m.nml:2:25: option 'xdr' belongs to the line of a buffer and does nothing (see the line of buffer "
        "'a')");
}

TEST(NmlConfig, AFileThatIsNotThereIsAnErrorWithItsName) {
    diagnostics::Sink sink;
    const auto config = load_config("/nonexistent/m.nml", sink);
    ASSERT_FALSE(config.has_value());
    EXPECT_TRUE(config.error().isTold);
    ASSERT_EQ(sink.count_errors(), 1);
    EXPECT_NE(sink.all()[0].what.str().find("/nonexistent/m.nml"), std::string::npos);
}

}  // namespace
}  // namespace mw::nml
