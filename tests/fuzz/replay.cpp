// SPDX-License-Identifier: Apache-2.0
// Runs a fuzz target on every file in the given folders: relief_replay_X [--mutants N] FOLDER…. With --mutants, also on N
// mutants of each file, made by the target's custom mutator; they are the same in every run.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "tests/fuzz/target.h"

extern "C" [[gnu::weak]] std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                                             std::size_t max_size, unsigned seed);

namespace {

std::mt19937 numbers;

std::size_t below(std::size_t end) {
    return numbers() % end;
}

void runMutants(const std::string& bytes, int count) {
    std::vector<std::uint8_t> mutant(bytes.size() + 16);
    for (int i = 0; i < count; ++i) {
        std::copy(bytes.begin(), bytes.end(), mutant.begin());
        const std::size_t size = LLVMFuzzerCustomMutator(mutant.data(), bytes.size(), mutant.size(),
                                                         static_cast<unsigned>(numbers()));
        LLVMFuzzerTestOneInput(mutant.data(), size);
    }
}

}  // namespace

// Called by the custom mutator in place of libFuzzer's function: changes one to four bytes or four-byte numbers, or
// removes or repeats a few bytes.
extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size) {
    if (size > 16 && below(16) == 0) {
        const std::size_t count = 1 + below(16);
        const std::size_t at = below(size - count);
        if (below(2) == 0) {
            std::copy(data + at + count, data + size, data + at);
            return size - count;
        }
        if (size + count <= max_size) {
            std::copy_backward(data + at, data + size, data + size + count);
            return size + count;
        }
    }
    for (std::size_t changes = 1 + below(4); changes > 0; --changes) {
        // Half of them in the header and the metadata, which are short.
        const std::size_t at = below(below(2) == 0 ? size : std::min<std::size_t>(size, 600));
        constexpr std::uint8_t kCommon[] = {0, 1, 2, 4, 127, 128, 254, 255};
        const std::size_t count = below(4) == 0 ? std::min<std::size_t>(4, size - at) : 1;
        for (std::size_t i = 0; i < count; ++i) {
            data[at + i] = below(2) == 0 ? kCommon[below(8)] : static_cast<std::uint8_t>(numbers());
        }
    }
    return size;
}

int main(int argc, char** argv) {
    namespace fs = std::filesystem;
    std::vector<fs::path> files;
    const bool mutates = argc > 2 && std::string_view(argv[1]) == "--mutants";
    const int mutants = mutates ? std::stoi(argv[2]) : 0;
    if (mutates && (mutants <= 0 || LLVMFuzzerCustomMutator == nullptr)) {
        std::fprintf(stderr, "--mutants needs a positive number and a target with a mutator\n");
        return 1;
    }
    for (int i = mutates ? 3 : 1; i < argc; ++i) {
        for (const fs::directory_entry& entry : fs::directory_iterator(argv[i])) {
            files.push_back(entry.path());
        }
    }
    std::sort(files.begin(), files.end());
    for (const fs::path& file : files) {
        std::ifstream stream(file, std::ios::binary);
        const std::string bytes{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
        if (!stream.is_open() || bytes.empty()) {
            std::fprintf(stderr, "%s cannot be read\n", file.c_str());
            return 1;
        }
        std::printf("%s\n", file.filename().c_str());  // in case the run crashes
        std::fflush(stdout);
        LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
        runMutants(bytes, mutants);
    }
    std::printf("%zu inputs\n", files.size());
    return files.empty() ? 1 : 0;
}
