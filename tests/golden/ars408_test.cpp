// No recording of an ARS408 exists, so random frames are decoded by the codec and by tshark's Signal-PDU dissector. The
// dissector gets the layouts in the form of the public interface description: widths from the first bit to the last.
// The codec has start bits instead.
#include "interfaces/wire/ars408.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

#include "services/ingest_gateway/codecs/ars408_commands.hpp"

namespace boresight::golden {
namespace {

namespace fs = std::filesystem;
namespace layout = wire::ars408;
using ingest::ars408::CommandFrame;

/// A signal in tshark's description; without a name: unused bits.
struct Described {
  std::string name;
  unsigned bits;
  double factor = 1.0;
  double offset = 0.0;
  const wire::CanSignal* ours = nullptr;  ///< the codec's value; null: tshark only
};

struct Message {
  std::string name;
  std::uint32_t id;
  std::vector<Described> signals;

  [[nodiscard]] std::size_t bytes() const {
    unsigned bits = 0;
    for (const Described& signal : signals) bits += signal.bits;
    return bits / 8;
  }
};

const std::vector<Message> kMessages{
    {"Cluster_0_Status",
     0x600,
     {{"NofClustersNear", 8, 1.0, 0.0, &layout::cluster_status::kNear},
      {"NofClustersFar", 8, 1.0, 0.0, &layout::cluster_status::kFar},
      {"MeasCounter", 16, 1.0, 0.0, &layout::cluster_status::kMeasurementCounter},
      {"InterfaceVersion", 4, 1.0, 0.0, &layout::cluster_status::kInterfaceVersion},
      {"", 4}}},
    {"Cluster_1_General",
     0x701,
     {{"ID", 8, 1.0, 0.0, &layout::kEntryId},
      {"DistLong", 13, 0.2, -500.0, &layout::general::kLongitudinal_m},
      {"", 1},
      {"DistLat", 10, 0.2, -102.3, &layout::general::kClusterLateral_m},
      {"VrelLong", 10, 0.25, -128.0, &layout::general::kLongitudinalVelocity_mps},
      {"VrelLat", 9, 0.25, -64.0, &layout::general::kLateralVelocity_mps},
      {"", 2},
      {"DynProp", 3, 1.0, 0.0, &layout::general::kDynamicProperty},
      {"RCS", 8, 0.5, -64.0, &layout::general::kRcs_dbsm}}},
    {"Cluster_2_Quality",
     0x702,
     {{"ID", 8, 1.0, 0.0, &layout::kEntryId},
      {"DistLong_rms", 5, 1.0, 0.0, &layout::quality::kLongitudinal},
      {"DistLat_rms", 5, 1.0, 0.0, &layout::quality::kLateral},
      {"VrelLong_rms", 5, 1.0, 0.0, &layout::quality::kLongitudinalVelocity},
      {"VrelLat_rms", 5, 1.0, 0.0, &layout::quality::kLateralVelocity},
      {"", 1},
      {"PdH0", 3, 1.0, 0.0, &layout::cluster_quality::kFalseAlarm},
      {"InvalidState", 5, 1.0, 0.0, &layout::cluster_quality::kInvalidState},
      {"AmbigState", 3, 1.0, 0.0, &layout::cluster_quality::kAmbiguityState}}},
    {"Obj_0_Status",
     0x60A,
     {{"NofObjects", 8, 1.0, 0.0, &layout::object_status::kCount},
      {"MeasCounter", 16, 1.0, 0.0, &layout::object_status::kMeasurementCounter},
      {"InterfaceVersion", 4, 1.0, 0.0, &layout::object_status::kInterfaceVersion},
      {"", 4}}},
    {"Obj_1_General",
     0x60B,
     {{"ID", 8, 1.0, 0.0, &layout::kEntryId},
      {"DistLong", 13, 0.2, -500.0, &layout::general::kLongitudinal_m},
      {"DistLat", 11, 0.2, -204.6, &layout::general::kObjectLateral_m},
      {"VrelLong", 10, 0.25, -128.0, &layout::general::kLongitudinalVelocity_mps},
      {"VrelLat", 9, 0.25, -64.0, &layout::general::kLateralVelocity_mps},
      {"", 2},
      {"DynProp", 3, 1.0, 0.0, &layout::general::kDynamicProperty},
      {"RCS", 8, 0.5, -64.0, &layout::general::kRcs_dbsm}}},
    {"Obj_2_Quality",
     0x60C,
     {{"ID", 8, 1.0, 0.0, &layout::kEntryId},
      {"DistLong_rms", 5, 1.0, 0.0, &layout::quality::kLongitudinal},
      {"DistLat_rms", 5, 1.0, 0.0, &layout::quality::kLateral},
      {"VrelLong_rms", 5, 1.0, 0.0, &layout::quality::kLongitudinalVelocity},
      {"VrelLat_rms", 5, 1.0, 0.0, &layout::quality::kLateralVelocity},
      {"ArelLong_rms", 5, 1.0, 0.0, &layout::object_quality::kLongitudinalAcceleration},
      {"ArelLat_rms", 5, 1.0, 0.0, &layout::object_quality::kLateralAcceleration},
      {"Orientation_rms", 5, 1.0, 0.0, &layout::object_quality::kOrientation},
      {"", 5},
      {"ProbOfExist", 3, 1.0, 0.0, &layout::object_quality::kExistence},
      {"MeasState", 3, 1.0, 0.0, &layout::object_quality::kMeasurementState},
      {"", 2}}},
    {"Obj_3_Extended",
     0x60D,
     {{"ID", 8, 1.0, 0.0, &layout::kEntryId},
      {"ArelLong", 11, 0.01, -10.0, &layout::object_extended::kLongitudinalAcceleration_mps2},
      {"ArelLat", 9, 0.01, -2.5, &layout::object_extended::kLateralAcceleration_mps2},
      {"", 1},
      {"Class", 3, 1.0, 0.0, &layout::object_extended::kClass},
      {"OrientationAngle", 10, 0.4, -180.0, &layout::object_extended::kOrientation_deg},
      {"", 6},
      {"Length", 8, 0.2, 0.0, &layout::object_extended::kLength_m},
      {"Width", 8, 0.2, 0.0, &layout::object_extended::kWidth_m}}},
    {"RadarState",
     0x201,
     {{"NVMReadStatus", 1},
      {"NVMwriteStatus", 1},
      {"", 6},
      {"MaxDistanceCfg", 10, 2.0, 0.0, &layout::state::kMaxDistance_m},
      {"Persistent_Error", 1, 1.0, 0.0, &layout::state::kPersistentError},
      {"Interference", 1, 1.0, 0.0, &layout::state::kInterference},
      {"Temperature_Error", 1, 1.0, 0.0, &layout::state::kTemperatureError},
      {"Temporary_Error", 1, 1.0, 0.0, &layout::state::kTemporaryError},
      {"Voltage_Error", 1, 1.0, 0.0, &layout::state::kVoltageError},
      {"", 7},
      {"RadarPowerCfg", 3},
      {"SortIndex", 3},
      {"", 1},
      {"SensorID", 3, 1.0, 0.0, &layout::state::kSensorId},
      {"MotionRxState", 2, 1.0, 0.0, &layout::state::kMotion},
      {"SendExtInfoCfg", 1},
      {"SendQualityCfg", 1},
      {"OutputTypeCfg", 2},
      {"CtrlRelayCfg", 1},
      {"", 9},
      {"", 8}}},
    {"RadarConfiguration", 0x200, {{"StoreInNVM_valid", 1},  {"SortIndex_valid", 1},
                                   {"SendExtInfo_valid", 1}, {"SendQuality_valid", 1},
                                   {"OutputType_valid", 1},  {"RadarPower_valid", 1},
                                   {"SensorID_valid", 1},    {"MaxDistance_valid", 1},
                                   {"MaxDistance", 10},      {"", 14},
                                   {"RadarPower", 3},        {"OutputType", 2},
                                   {"SensorID", 3},          {"StoreInNVM", 1},
                                   {"SortIndex", 3},         {"SendExtInfo", 1},
                                   {"SendQuality", 1},       {"CtrlRelay", 1},
                                   {"CtrlRelay_valid", 1},   {"", 16}}},
    {"SpeedInformation",
     0x300,
     {{"SpeedDirection", 2, 1.0, 0.0, &layout::ego::kDirection},
      {"", 1},
      {"Speed", 13, 0.02, 0.0, &layout::ego::kSpeed_mps}}},
    {"YawRateInformation", 0x301, {{"YawRate", 16, 0.01, -327.68, &layout::ego::kYawRate_degps}}},
};

struct CanFrame {
  std::uint32_t id;
  std::vector<std::uint8_t> bytes;
};

CanFrame frame_of(const CommandFrame& command) {
  return {command.can_id, {command.payload().begin(), command.payload().end()}};
}

/// A frame decoded by tshark: physical value and raw code by "message.signal".
struct Value {
  double physical;
  double code;
};
using DecodedSignals = std::map<std::string, Value>;

class Tshark {
 public:
  Tshark() {
    std::string folder = (fs::temp_directory_path() / "boresight_tshark_XXXXXX").string();
    if (mkdtemp(folder.data()) == nullptr) throw std::runtime_error("no temporary folder");
    folder_ = folder;
  }
  ~Tshark() {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }
  Tshark(const Tshark&) = delete;
  Tshark& operator=(const Tshark&) = delete;

  /// Version of tshark, such as "4.0.17"; empty without tshark.
  static std::string version() {
    const std::string text = output_of("tshark --version 2>/dev/null");
    const std::size_t begin = text.find_first_of("0123456789");
    return begin == std::string::npos ? "" : text.substr(begin, text.find_first_not_of("0123456789.", begin) - begin);
  }

  std::vector<DecodedSignals> decode(const std::vector<CanFrame>& frames) const {
    write_configuration();
    write_capture(frames);
    std::string command = "WIRESHARK_CONFIG_DIR=" + folder_.string() + " tshark -r " + (folder_ / "can.pcap").string() +
                          " -T fields -E separator=,";
    std::vector<std::string> names;
    for (const Message& message : kMessages) {
      for (const Described& signal : message.signals) {
        if (signal.name.empty()) continue;
        names.push_back(message.name + "." + signal.name);
        command += " -e signal_pdu." + names.back() + " -e signal_pdu." + names.back() + "_raw";
      }
    }
    std::istringstream lines(output_of(command + " 2>" + (folder_ / "errors").string()));
    std::vector<DecodedSignals> decoded;
    for (std::string line; std::getline(lines, line);) {
      std::istringstream cells(line + ",");
      DecodedSignals& values = decoded.emplace_back();
      std::string physical, code;
      for (std::size_t i = 0; std::getline(cells, physical, ',') && std::getline(cells, code, ',') && i < names.size();
           ++i) {
        if (!code.empty()) values[names[i]] = {std::atof(physical.c_str()), std::atof(code.c_str())};
      }
    }
    return decoded;
  }
  [[nodiscard]] std::string errors() const {
    std::ifstream input(folder_ / "errors");
    return {std::istreambuf_iterator<char>(input), {}};
  }

 private:
  static std::string output_of(const std::string& command) {
    std::string text;
    FILE* const pipe = popen(command.c_str(), "r");
    if (pipe == nullptr) return text;
    std::array<char, 65536> buffer;
    for (std::size_t n = 0; (n = std::fread(buffer.data(), 1, buffer.size(), pipe)) > 0;) text.append(buffer.data(), n);
    pclose(pipe);
    return text;
  }

  void write_configuration() const {
    std::ofstream names(folder_ / "Signal_PDU_identifiers");
    std::ofstream bindings(folder_ / "Signal_PDU_Binding_CAN");
    std::ofstream signals(folder_ / "Signal_PDU_signal_list");
    std::array<char, 32> id{};
    for (std::size_t m = 0; m < kMessages.size(); ++m) {
      const Message& message = kMessages[m];
      std::snprintf(id.data(), id.size(), "\"%08zx\"", m + 1);
      names << id.data() << ",\"" << message.name << "\"\n";
      std::array<char, 32> can_id{};
      std::snprintf(can_id.data(), can_id.size(), "\"%08x\"", message.id);
      bindings << can_id.data() << ",\"0000\"," << id.data() << "\n";
      for (std::size_t s = 0; s < message.signals.size(); ++s) {
        const Described& signal = message.signals[s];
        const std::string name = signal.name.empty() ? "gap" + std::to_string(s) : signal.name;
        // PDU, number of signals, position, name, filter, type, big endian, bits of the type, bits, factor, offset,
        // is multiplexer, multiplexer value, hidden
        signals << id.data() << ",\"" << message.signals.size() << "\",\"" << s << "\",\"" << name << "\",\""
                << message.name << "." << name << "\",\"uint\",\"TRUE\",\"" << (signal.bits > 8 ? 16 : 8) << "\",\""
                << signal.bits << "\",\"" << signal.factor << "\",\"" << signal.offset << "\",\"FALSE\",\"-1\",\""
                << (signal.name.empty() ? "TRUE" : "FALSE") << "\"\n";
      }
    }
  }

  void write_capture(const std::vector<CanFrame>& frames) const {
    std::ofstream file(folder_ / "can.pcap", std::ios::binary);
    const auto little = [&file](std::uint32_t value, int bytes) {
      for (int i = 0; i < bytes; ++i) file.put(static_cast<char>(value >> 8 * i));
    };
    little(0xA1B2C3D4, 4);
    little(2, 2);
    little(4, 2);
    little(0, 4);
    little(0, 4);
    little(65535, 4);
    little(227, 4);  // SocketCAN
    for (const CanFrame& frame : frames) {
      const auto size = static_cast<std::uint32_t>(8 + frame.bytes.size());
      little(0, 4);
      little(0, 4);
      little(size, 4);
      little(size, 4);
      for (int shift = 24; shift >= 0; shift -= 8) file.put(static_cast<char>(frame.id >> shift));
      little(static_cast<std::uint32_t>(frame.bytes.size()), 4);  // length, three bytes of zero
      for (const std::uint8_t byte : frame.bytes) file.put(static_cast<char>(byte));
    }
  }

  fs::path folder_;
};

class Ars408Tshark : public testing::Test {
 protected:
  void SetUp() override {
    const std::string version = Tshark::version();
    if (version.empty()) GTEST_SKIP() << "skipped: no tshark";
    if (version.rfind("4.0", 0) != 0) GTEST_SKIP() << "skipped: the description is in the format of tshark 4.0";
  }
  Tshark tshark_;
};

TEST_F(Ars408Tshark, ExtractsTheSameFromRandomFrames) {
  std::mt19937 random(20408);
  std::vector<CanFrame> frames;
  std::vector<const Message*> messages;
  for (int i = 0; i < 3000; ++i) {
    messages.push_back(&kMessages[random() % kMessages.size()]);
    CanFrame& frame = frames.emplace_back(CanFrame{messages.back()->id, {}});
    for (std::size_t k = 0; k < messages.back()->bytes(); ++k) {
      frame.bytes.push_back(static_cast<std::uint8_t>(random()));
    }
  }
  const std::vector<DecodedSignals> decoded = tshark_.decode(frames);
  ASSERT_EQ(decoded.size(), frames.size()) << tshark_.errors();
  std::size_t compared = 0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    for (const Described& signal : messages[i]->signals) {
      if (signal.ours == nullptr) continue;
      const std::string name = messages[i]->name + "." + signal.name;
      const auto theirs = decoded[i].find(name);
      ASSERT_NE(theirs, decoded[i].end()) << name << " of frame " << i << " " << tshark_.errors();
      ASSERT_TRUE(wire::fits(*signal.ours, frames[i].bytes.size())) << name;
      EXPECT_EQ(static_cast<double>(wire::extract_raw(*signal.ours, frames[i].bytes)), theirs->second.code) << name;
      EXPECT_NEAR(wire::extract(*signal.ours, frames[i].bytes), theirs->second.physical, 1e-9) << name;
      ++compared;
    }
  }
  std::printf("%zu values of %zu frames compared\n", compared, frames.size());
  EXPECT_GT(compared, 10'000u);
}

TEST_F(Ars408Tshark, ReadsTheCommandsAsTheyAreMeant) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> speed(-60.0F, 60.0F), yaw_rate(-5.0F, 5.0F);
  std::vector<EgoMotion> motions(200);
  std::vector<CanFrame> frames;
  for (EgoMotion& ego : motions) {
    ego.fields = ego_field::kSpeed | ego_field::kYawRate | ego_field::kReverse;
    ego.speed_mps = speed(random);
    ego.yaw_rate_radps = yaw_rate(random);
    frames.push_back(frame_of(ingest::ars408::ego_speed(ego, 0).value()));
    frames.push_back(frame_of(ingest::ars408::ego_yaw_rate(ego, 0).value()));
  }
  frames.push_back(frame_of(ingest::ars408::configuration(ingest::ars408::Output::kClusters, 0)));
  frames.push_back(frame_of(ingest::ars408::configuration(ingest::ars408::Output::kObjects, 0)));
  const std::vector<DecodedSignals> decoded = tshark_.decode(frames);
  ASSERT_EQ(decoded.size(), frames.size()) << tshark_.errors();
  for (std::size_t i = 0; i < motions.size(); ++i) {
    const double mps = decoded[2 * i].at("SpeedInformation.Speed").physical;
    const double direction = decoded[2 * i].at("SpeedInformation.SpeedDirection").physical;
    EXPECT_NEAR(mps, std::abs(motions[i].speed_mps), 0.01001);
    EXPECT_EQ(direction, mps == 0.0 ? 0.0 : motions[i].speed_mps > 0.0F ? 1.0 : 2.0);
    const double degps = decoded[2 * i + 1].at("YawRateInformation.YawRate").physical;
    EXPECT_NEAR(degps, motions[i].yaw_rate_radps * 180.0 / M_PI, 0.00501);
  }
  for (const double output : {2.0, 1.0}) {  // clusters, objects
    const DecodedSignals& configuration = decoded[decoded.size() - (output == 2.0 ? 2 : 1)];
    for (const char* const valid : {"StoreInNVM", "SortIndex", "SendExtInfo", "SendQuality", "OutputType"}) {
      EXPECT_EQ(configuration.at("RadarConfiguration." + std::string(valid) + "_valid").code, 1.0) << valid;
    }
    for (const char* const untouched : {"RadarPower", "SensorID", "MaxDistance", "CtrlRelay"}) {
      EXPECT_EQ(configuration.at("RadarConfiguration." + std::string(untouched) + "_valid").code, 0.0) << untouched;
    }
    EXPECT_EQ(configuration.at("RadarConfiguration.OutputType").code, output);
    EXPECT_EQ(configuration.at("RadarConfiguration.SendQuality").code, 1.0);
    EXPECT_EQ(configuration.at("RadarConfiguration.SendExtInfo").code, 1.0);
    EXPECT_EQ(configuration.at("RadarConfiguration.SortIndex").code, 1.0);
    EXPECT_EQ(configuration.at("RadarConfiguration.StoreInNVM").code, 1.0);
  }
}

}  // namespace
}  // namespace boresight::golden
