// SPDX-License-Identifier: GPL-2.0-or-later
// The values of an NML configuration file: config_file reads its text once (F3).
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
    SHMEM,    ///< memory that processes of this computer share
    LOCMEM,   ///< memory of one process
    FILEMEM,  ///< a file
    PHANTOM,  ///< takes everything and gives nothing
    GLOBMEM,  ///< memory on a backplane: there is none under Linux
};

/// Who keeps accesses to a buffer apart.
enum class Mutex : std::uint8_t {
    OS_SEM,         ///< a lock that the kernel gives back when its holder dies
    NONE,           ///< no lock: one process writes, one reads
    NO_INTERRUPTS,  ///< not on Linux: as OS_SEM
    NO_SWITCHING,   ///< not on Linux: as OS_SEM
    MAO,            ///< several copies of the message: readers never wait for the writer
};

/// A line "B name type host size neut RPC# buffer# max_procs key [options]".
struct BufferSettings {
    std::string name;
    BufferKind kind = BufferKind::SHMEM;
    std::string host;      ///< where its server runs
    std::size_t size = 0;  ///< of the largest message; of a queue: of all that wait. [bytes]
    bool neutral = false;
    int rpc_number = 0;     ///< means nothing any more
    int buffer_number = 0;  ///< by which a server knows it
    int max_processes = 1;
    std::int64_t key = 0;  ///< by which processes find the memory

    Mutex mutex = Mutex::OS_SEM;
    int copies = 2;  ///< of MAO
    std::optional<int> tcp_port;
    std::optional<int> stcp_port;
    std::optional<int> udp_port;
    std::string serial_device;
    std::string password_file;
    std::optional<std::int64_t> blocking_key;  ///< -1: reads may not wait for a message
    bool is_queue = false;
    std::optional<Encoding> encoding;
    bool diagnosed = false;        ///< counts and times of each access are kept
    bool write_confirmed = false;  ///< a remote write ends when the server has it
    bool isNumbered = false;       ///< the buffer gives commands their serial numbers
    std::string file;              ///< of FILEMEM
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
    bool isMaster = false;  ///< makes the buffer and takes it away
    int connection_number = 0;
    SourcePlace place;
};

/// Name of the line for all buffers without a separate line of the process.
inline constexpr std::string_view DEFAULT_BUFFER = "default";

struct Config {
    std::vector<BufferSettings> buffers;
    std::vector<ProcessSettings> processes;

    const BufferSettings *find_buffer(std::string_view name) const;
    /// How `process` uses `buffer`: by its own line, else by its line for DEFAULT_BUFFER. Null when it may
    /// not.
    const ProcessSettings *find_process(std::string_view process, std::string_view buffer) const;
};

}  // namespace mw::nml
