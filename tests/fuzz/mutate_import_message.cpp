// Mutants of a message whose sizes must add up to the last byte die at the sum. So most of them get counts
// that fit, and what lies behind is met.
#include <flatbuffers/flatbuffers.h>

#include <cstring>
#include <span>

#include "import_message_generated.h"

namespace {

constexpr std::size_t kPrefixBytes = 16;
constexpr std::size_t kItemBytes = 12;  // of a position and of a triangle

/// Writes `value` where the table keeps a field, if it does.
void set(std::span<std::uint8_t> bytes, const flatbuffers::Table& table, flatbuffers::voffset_t field,
         std::uint64_t value) {
    const std::uint8_t* address = table.GetAddressOf(field);
    if (address != nullptr) {
        std::memcpy(bytes.data() + (address - bytes.data()), &value, sizeof(value));
    }
}

/// Makes the counts say what the bytes hold. \return the bytes that remain.
std::size_t mend(std::span<std::uint8_t> bytes, unsigned seed) {
    std::uint64_t table_bytes = 0;
    if (bytes.size() < kPrefixBytes) {
        return bytes.size();
    }
    std::memcpy(&table_bytes, bytes.data(), sizeof(table_bytes));
    if (table_bytes < 8 || table_bytes > bytes.size() - kPrefixBytes) {
        return bytes.size();
    }
    std::uint8_t* data = bytes.data() + kPrefixBytes;
    flatbuffers::Verifier verifier(data, table_bytes);
    const std::size_t head = (kPrefixBytes + table_bytes + 15) / 16 * 16;
    if (head > bytes.size() || !relief::import_fb::VerifyMessageBuffer(verifier)) {
        return bytes.size();
    }
    using relief::import_fb::Message;
    const auto& table = *flatbuffers::GetRoot<flatbuffers::Table>(data);
    const bool marked = table.GetAddressOf(Message::VT_MARKS) != nullptr;
    const std::size_t triangle_bytes = kItemBytes + (marked ? 1 : 0);
    const std::size_t triangles = seed % ((bytes.size() - head) / triangle_bytes + 1);
    const std::size_t positions = (bytes.size() - head - triangles * triangle_bytes) / kItemBytes;
    set(bytes, table, Message::VT_POSITIONS, positions);
    set(bytes, table, Message::VT_TRIANGLES, triangles);
    set(bytes, table, Message::VT_MARKS, triangles);
    return head + positions * kItemBytes + triangles * triangle_bytes;
}

}  // namespace

// Of libFuzzer.
extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned seed) {
    const std::size_t new_size = LLVMFuzzerMutate(data, size, max_size);
    return seed % 8 == 0 ? new_size : mend({data, new_size}, seed / 8);
}
