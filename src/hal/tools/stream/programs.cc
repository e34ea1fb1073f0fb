// SPDX-License-Identifier: GPL-2.0-or-later
#include "hal/tools/stream/programs.hh"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <fstream>
#include <iostream>
#include <memory>

#include <fmt/format.h>

#include "base/language/language.hh"
#include "hal/tools/stream/keys.hh"
#include "hal/tools/stream/record_text.hh"

namespace mw::hal::stream_tools {

namespace {

void nap() {
    constexpr long POLL_NS = 1000000;
    const timespec pause{0, POLL_NS};
    nanosleep(&pause, nullptr);
}

/// A component of this program with one stream attached.
class Attachment {
  public:
    ~Attachment() {
        if (attached_) {
            hal_stream_detach(&stream);
        }
        if (comp_id_ > 0) {
            hal_exit(comp_id_);
        }
    }

    Result<> open(const char *program, int key, int channel) {
        if (channel < 0 || channel >= MAX_CHANNELS) {
            return fail(fmt::format("channel {} is not 0 to {}", channel, MAX_CHANNELS - 1));
        }
        const std::string name = fmt::format("{}{}", program, getpid());
        comp_id_ = hal_init(name.c_str());
        if (comp_id_ < 0) {
            return fail(fmt::format("cannot join HAL: {}", std::strerror(-comp_id_)));
        }
        const int status = hal_stream_attach(&stream, comp_id_, key + channel, nullptr);
        if (status < 0) {
            const std::string why = status == -EINVAL ? "" : fmt::format(": {}", std::strerror(-status));
            return fail(fmt::format("no stream for channel {}{}", channel, why), {},
                        "load the realtime component first");
        }
        attached_ = true;
        for (int i = 0; i < hal_stream_element_count(&stream); ++i) {
            types.push_back(hal_stream_element_type(&stream, i));
        }
        hal_ready(comp_id_);
        return {};
    }

    hal_stream_t stream{};
    std::vector<hal_type_t> types;

  private:
    int comp_id_ = 0;
    bool attached_ = false;
};

struct CloseFile {
    void operator()(std::FILE *file) const {
        if (file != stdout) {
            std::fclose(file);
        }
    }
};

}  // namespace

Result<> run_sampler(const SamplerOptions &options, volatile std::sig_atomic_t &stop) {
    Attachment attachment;
    const Result<> opened = attachment.open("halsampler", SAMPLER_KEY, options.channel);
    if (!opened) {
        return opened;
    }
    const std::unique_ptr<std::FILE, CloseFile> out(
        options.file.empty() ? stdout : std::fopen(options.file.c_str(), "w"));
    if (!out) {
        return fail(fmt::format("cannot write '{}': {}", options.file, std::strerror(errno)));
    }
    hal_stream_data_u record[HAL_STREAM_MAX_PINS];
    unsigned expected = 0;
    for (long done = 0; options.count < 0 || done < options.count;) {
        if (stop != 0) {
            return fail("stopped before all samples were read");
        }
        unsigned number = 0;
        if (hal_stream_read(&attachment.stream, record, &number) < 0) {
            std::fflush(out.get());
            nap();
            continue;
        }
        const bool is_gap = done > 0 && number != expected;
        expected = number + 1;
        // The stream counts from 1, the text from 0.
        const std::string tag = options.tagged ? fmt::format("{} ", number - 1) : "";
        const std::string line = format_record(attachment.types, record);
        const int written =
            std::fprintf(out.get(), "%s%s%s\n", is_gap ? "overrun\n" : "", tag.c_str(), line.c_str());
        if (written < 0) {
            return fail(fmt::format("cannot write samples: {}", std::strerror(errno)));
        }
        ++done;
    }
    return {};
}

Result<> run_streamer(const StreamerOptions &options, volatile std::sig_atomic_t &stop) {
    Attachment attachment;
    const Result<> opened = attachment.open("halstreamer", STREAMER_KEY, options.channel);
    if (!opened) {
        return opened;
    }
    std::ifstream file;
    if (!options.file.empty()) {
        file.open(options.file);
        if (!file) {
            return fail(fmt::format("cannot read '{}': {}", options.file, std::strerror(errno)));
        }
    }
    std::istream &in = options.file.empty() ? std::cin : file;
    std::string line;
    for (int number = 1; std::getline(in, line); ++number) {
        if (isSkipped(line)) {
            continue;
        }
        // The last line may be truncated if it has no newline.
        Result<std::vector<hal_stream_data_u>> record =
            in.eof() ? fail("the line has no end") : parse_record(attachment.types, line);
        if (!record) {
            record.error().place = {options.file.empty() ? "stdin" : options.file, number, 0};
            language::tell(fmt::format("halstreamer: {}; line skipped", record.error().str()));
            continue;
        }
        // Checked first, because a failed write would count as an overrun.
        while (!hal_stream_writable(&attachment.stream)) {
            if (stop != 0) {
                return fail("stopped before the end of the input");
            }
            nap();
        }
        hal_stream_write(&attachment.stream, record->data());
    }
    if (stop != 0) {
        return fail("stopped before the end of the input");
    }
    return {};
}

}  // namespace mw::hal::stream_tools
