// SPDX-License-Identifier: GPL-2.0-or-later
// The values of an NML configuration file; config_file reads its text once (F3).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.hh"
#include "clients/nml/encoding.hh"
#include "clients/nml/timeout.hh"

namespace mw::nml {

enum class BufferKind : std::uint8_t {
    SHMEM,    ///< memory shared by processes of this computer
    LOCMEM,   ///< memory of one process
    FILEMEM,  ///< a file
    PHANTOM,  ///< accepts all messages and returns none
    GLOBMEM,  ///< memory on a backplane, which does not exist under Linux
};

/// Method that excludes concurrent accesses to a buffer.
enum class Mutex : std::uint8_t {
    OS_SEM,         ///< a lock that the kernel releases when its holder dies
    NONE,           ///< no lock: one writer and one reader
    NO_INTERRUPTS,  ///< not available on Linux; treated as OS_SEM
    NO_SWITCHING,   ///< not available on Linux; treated as OS_SEM
    MAO,            ///< several copies of the message, so that readers never wait for the writer
};

/// A line "B name type host size neut RPC# buffer# max_procs key [options]".
struct BufferSettings {
    std::string name;
    BufferKind kind = BufferKind::SHMEM;
    std::string host;      ///< host on which its server runs
    std::size_t size = 0;  ///< size of the largest message; for a queue of all waiting messages [bytes]
    bool neutral = false;
    int rpc_number = 0;     ///< without effect
    int buffer_number = 0;  ///< number by which a server knows the buffer
    int max_processes = 1;
    std::int64_t key = 0;  ///< key by which processes find the memory

    Mutex mutex = Mutex::OS_SEM;
    int copies = 2;  ///< number of copies for MAO
    std::optional<int> tcp_port;
    std::optional<int> stcp_port;
    std::optional<int> udp_port;
    std::string serial_device;
    std::string password_file;
    std::optional<std::int64_t> blocking_key;  ///< -1: reads may not wait for a message
    bool is_queue = false;
    std::optional<Encoding> encoding;
    bool diagnosed = false;        ///< counts and times of each access are stored
    bool write_confirmed = false;  ///< a remote write ends when the server has received it
    bool isNumbered = false;       ///< the buffer assigns serial numbers to commands
    std::string file;              ///< file of FILEMEM
    SourcePlace place;

    bool isBlockingAllowed() const { return blocking_key != -1; }
};

/// A line "P name buffer type host ops server timeout master c_num [options]".
struct ProcessSettings {
    std::string name;
    std::string buffer;
    bool isRemote = false;
    std::string host;
    bool mayRead = false;
    bool mayWrite = false;
    bool is_server = false;
    Timeout timeout;
    bool isMaster = false;  ///< creates and removes the buffer
    int connection_number = 0;
    SourcePlace place;
};

/// Name of the line for all buffers that have no line of the process.
inline constexpr std::string_view DEFAULT_BUFFER = "default";

struct Config {
    std::vector<BufferSettings> buffers;
    std::vector<ProcessSettings> processes;

    const BufferSettings *find_buffer(std::string_view name) const;
    /// The line by which `process` uses `buffer`: its own line, else its line for DEFAULT_BUFFER. Null if it
    /// may not use the buffer.
    const ProcessSettings *find_process(std::string_view process, std::string_view buffer) const;
};

}  // namespace mw::nml
