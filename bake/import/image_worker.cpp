// SPDX-License-Identifier: Apache-2.0
// Implements openImageRowsInWorker: starts relief-import, and reads the rows that it sends through a pipe.
#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <string>

#include "bake/import/image_rows.h"
#include "bake/import/import_process.h"
#include "bake/import/import_protocol.h"
#include "formats/base/descriptor.h"
#include "formats/base/text.h"

namespace relief {
namespace {

constexpr std::size_t kImageErrorBytesMax = 4096;
/// The largest pipe that an unprivileged user may request.
constexpr int kPipeBytes = 1 << 20;

constexpr std::array<unsigned char, 8> kPng = {0x89, 'P', 'N', 'G', 0x0d, 0x0a, 0x1a, 0x0a};
constexpr std::array<unsigned char, 4> kExr = {0x76, 0x2f, 0x31, 0x01};

bool beginsWith(std::span<const std::byte> bytes, std::span<const unsigned char> signature) {
    return bytes.size() >= signature.size() &&
           std::ranges::equal(bytes.first(signature.size()), std::as_bytes(signature));
}

class WorkerRows : public SampleRows {
  public:
    explicit WorkerRows(const ImportLimits& limits) : worker_("image", "use a smaller image", limits) {}

    Result<void> open(int image) {
        RELIEF_TRY(worker_.checkLimits());
        Descriptor end;
        if (const int failed = makePipe(pipe_, end)) {
            return ImportProcess::notStarted(failed);
        }
        // On failure, the worker buffers fewer rows.
        static_cast<void>(::fcntl(end.get(), F_SETPIPE_SZ, kPipeBytes));
        RELIEF_TRY(worker_.start("image", kImportImage, {std::string(kImportNamesMarker)},
                                 {image, -1, end.get(), end.get()}));
        end.reset();
        std::array<std::byte, 1> begun{};
        RELIEF_TRY(receive(begun));
        begun_ = true;
        ImageSize size;
        RELIEF_TRY(receiveAnswer(std::as_writable_bytes(std::span(&size, 1))));
        if (size.columns == 0 || size.rows == 0 ||
            (size.most != 0 && size.most != 255 && size.most != 65535)) {
            return invalidInput("the importer returned an invalid image size; save the image again");
        }
        columns_ = size.columns;
        rows_ = size.rows;
        most_ = static_cast<std::uint32_t>(size.most);
        return {};
    }

    Result<void> next(std::span<float> out) override { return receiveAnswer(std::as_writable_bytes(out)); }

  private:
    Result<void> receiveAnswer(std::span<std::byte> bytes) {
        const std::uint32_t code = RELIEF_TRY(receiveNumber());
        if (code == 0) {
            return receive(bytes);
        }
        std::string text(std::min<std::size_t>(RELIEF_TRY(receiveNumber()), kImageErrorBytesMax), ' ');
        RELIEF_TRY(receive(std::as_writable_bytes(std::span(text))));
        return code <= static_cast<std::uint32_t>(ErrorCode::kDifference)
                   ? fail(static_cast<ErrorCode>(code), cleanUtf8(text, kImageErrorBytesMax))
                   : invalidInput("the importer returned an unknown error; save the image again");
    }

    Result<std::uint32_t> receiveNumber() {
        std::uint32_t number = 0;
        RELIEF_TRY(receive(std::as_writable_bytes(std::span(&number, 1))));
        return number;
    }

    Result<void> receive(std::span<std::byte> bytes) {
        while (!bytes.empty()) {
            RELIEF_TRY(worker_.await(pipe_.get(), POLLIN));
            const ssize_t got = ::read(pipe_.get(), bytes.data(), bytes.size());
            if (got < 0 && errno == EINTR) {
                continue;
            }
            if (got <= 0) {
                RELIEF_TRY(worker_.finish(begun_));
                return fail(
                    ErrorCode::kFailure,
                    "the importer returned no result; try again, or save the image in another format");
            }
            bytes = bytes.subspan(static_cast<std::size_t>(got));
        }
        return {};
    }

    ImportProcess worker_;
    Descriptor pipe_;
    bool begun_ = false;
};

}  // namespace

bool isPng(std::span<const std::byte> bytes) {
    return beginsWith(bytes, kPng);
}

bool isImage(std::span<const std::byte> bytes) {
    return isPng(bytes) || beginsWith(bytes, kExr);
}

Result<std::unique_ptr<SampleRows>> openImageRowsInWorker(int image, const ImportLimits& limits) {
    auto rows = std::make_unique<WorkerRows>(limits);
    RELIEF_TRY(rows->open(image));
    return std::unique_ptr<SampleRows>(std::move(rows));
}

}  // namespace relief
