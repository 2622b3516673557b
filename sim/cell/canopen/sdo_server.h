#pragma once
// SDO server of a slave (CiA 301, 7.2.4): expedited and segmented transfers in both directions.
//
//   request               answer                byte 0 of the request (top three bits: the service)
//   initiate download     60h                   001 0 nn e s   e: data in the frame, s: size known
//   download segment      20h | toggle          000 t nnn c    c: last segment
//   initiate upload       43h.. or 41h + size   010
//   upload segment        t | nnn | c           011 t
//   abort                 none                  100
// Block transfer is answered by an abort. It neither sends nor knows time. One thread.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "sim/cell/canopen/object_dictionary.h"

namespace tenon::sim {

class SdoServer {
 public:
  using Message = std::array<std::uint8_t, 8>;

  /// @param dictionary must outlive the server
  explicit SdoServer(ObjectDictionary& dictionary) : dictionary_(dictionary) {}

  /// The answer to a request; none to an abort. A new initiate ends an unfinished transfer.
  [[nodiscard]] std::optional<Message> answer(const Message& request);

  void reset() { transfer_ = Transfer::kNone; }

 private:
  enum class Transfer : std::uint8_t { kNone, kDownload, kUpload };

  [[nodiscard]] Message initiate_download(const Message& request);
  [[nodiscard]] Message download_segment(const Message& request);
  [[nodiscard]] Message initiate_upload();
  [[nodiscard]] Message upload_segment(const Message& request);
  [[nodiscard]] Message abort(std::uint32_t code);
  /// A segment that belongs to no transfer, or to the other direction.
  [[nodiscard]] Message abort_stray();
  /// Bytes that the entry can take.
  [[nodiscard]] static std::size_t size_max(const ObjectEntry& entry);
  /// Length check and write. @return 0 or an abort code
  [[nodiscard]] std::uint32_t store(const std::vector<std::uint8_t>& bytes);
  [[nodiscard]] Message reply(std::uint8_t command) const;

  ObjectDictionary& dictionary_;
  Transfer transfer_ = Transfer::kNone;
  ObjectId id_ = 0;
  std::uint8_t toggle_ = 0;  ///< 00h or 10h, what the next segment must carry
  std::vector<std::uint8_t> bytes_;
  std::size_t offset_ = 0;                  ///< upload: what has gone out
  std::optional<std::uint32_t> announced_;  ///< download: size by the client
};

}  // namespace tenon::sim
