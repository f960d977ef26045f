// SPDX-License-Identifier: Apache-2.0
#include "bake/import/image_rows.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfVersion.h>

#include <algorithm>
#include <cstring>
#include <exception>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>

#include "formats/base/text.h"

namespace relief {
namespace {

class ByteStream : public Imf::IStream {
  public:
    explicit ByteStream(std::span<const std::byte> bytes) : Imf::IStream("image"), bytes_(bytes) {}

    bool read(char* out, int count) override {
        const auto size = static_cast<std::uint64_t>(std::max(count, 0));
        if (at_ > bytes_.size() || size > bytes_.size() - at_) {
            throw std::runtime_error("it is cut off");
        }
        std::memcpy(out, bytes_.data() + at_, size);
        at_ += size;
        return at_ < bytes_.size();
    }
    std::uint64_t tellg() override { return at_; }
    void seekg(std::uint64_t at) override { at_ = at; }

  private:
    std::span<const std::byte> bytes_;
    std::uint64_t at_ = 0;
};

tl::unexpected<Error> unreadable(const std::exception& e) {
    return invalidInput("it cannot be read as EXR: " + oneCleanLine(e.what()) + "; save it again");
}

class ExrRows : public SampleRows {
  public:
    explicit ExrRows(std::span<const std::byte> bytes) : stream_(bytes) {}

    Result<void> open() {
        try {
            // OpenEXR allocates whole rows when it opens a file. The limit applies to the whole process.
            static std::once_flag limited;
            std::call_once(limited,
                           [] { Imf::Header::setMaxImageSize(int{kHeightsSideMax}, int{kHeightsSideMax}); });
            file_.emplace(stream_);
            if (Imf::isMultiPart(file_->version())) {
                stream_.seekg(0);
                if (const int parts = Imf::MultiPartInputFile(stream_).parts(); parts > 1) {
                    return fail(ErrorCode::kUnsupported,
                                "it has " + std::to_string(parts) + " parts; save only the heights");
                }
            }
            const Imf::ChannelList& channels = file_->header().channels();
            std::size_t count = 0;
            for (auto channel = channels.begin(); channel != channels.end(); ++channel) {
                channel_ = channel.name();
                const Imf::Channel& sampling = channel.channel();
                count += sampling.xSampling == 1 && sampling.ySampling == 1 ? 1 : 2;
            }
            if (count != 1) {
                return fail(ErrorCode::kUnsupported,
                            "it needs exactly one channel, of full resolution; save only the heights");
            }
            const auto& window = file_->header().dataWindow();
            left_ = window.min.x;
            row_ = window.min.y;
            columns_ = static_cast<std::uint64_t>(std::int64_t{window.max.x} - window.min.x + 1);
            rows_ = static_cast<std::uint64_t>(std::int64_t{window.max.y} - window.min.y + 1);
            return {};
        } catch (const std::exception& e) {
            return unreadable(e);
        }
    }

    Result<void> next(std::span<float> out) override {
        try {
            Imf::FrameBuffer buffer;
            // Addresses are relative to pixel (0, 0), which may lie outside the data window. A stride of 0 maps every
            // row to the same memory.
            auto* const base = reinterpret_cast<char*>(out.data()) -
                               std::int64_t{left_} * static_cast<std::int64_t>(sizeof(float));
            buffer.insert(channel_, Imf::Slice(Imf::FLOAT, base, sizeof(float), 0));
            file_->setFrameBuffer(buffer);
            file_->readPixels(row_);
            ++row_;
            return {};
        } catch (const std::exception& e) {
            return unreadable(e);
        }
    }

  private:
    ByteStream stream_;
    std::optional<Imf::InputFile> file_;
    std::string channel_;
    int left_ = 0;
    int row_ = 0;
};

}  // namespace

Result<std::unique_ptr<SampleRows>> openExrRows(std::span<const std::byte> bytes) {
    auto rows = std::make_unique<ExrRows>(bytes);
    RELIEF_TRY(rows->open());
    return std::unique_ptr<SampleRows>(std::move(rows));
}

}  // namespace relief
