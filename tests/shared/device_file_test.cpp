// Description files of devices, with the slips that vendors' files have: each is read, or refused
// by file and line.

#include "shared/eds/device_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "shared/base/text.h"
#include "shared/config/files.h"
#include "tests/support/places.h"
#include "tests/support/refusal.h"

namespace tenon {
namespace {

/// Sections behind a head without slips; line 1 of `sections` is line 9 of the file.
DeviceFile parsed(const std::string& sections) {
  return parse_device_file("a.eds",
                           "[DeviceInfo]\nVendorName=someone\n[MandatoryObjects]\n"
                           "SupportedObjects=0\n[OptionalObjects]\nSupportedObjects=0\n"
                           "[ManufacturerObjects]\nSupportedObjects=0\n" +
                               sections);
}

std::string refused(const std::string& sections) {
  return tests::refusal([&] { (void)parsed(sections); });
}

const DeviceObject& object(const DeviceFile& file, std::uint16_t index, std::uint8_t sub = 0) {
  const DeviceObject* found = file.find(index, sub);
  EXPECT_NE(found, nullptr) << std::hex << index;
  static const DeviceObject kNone;
  return found != nullptr ? *found : kNone;
}

TEST(DeviceFile, ReadsAVariableWithAllThatItSays) {
  const DeviceFile file = parsed(
      "[6085]\nParameterName=Quick stop deceleration\nObjectType=0x7\nDataType=0x0007\n"
      "AccessType=rw\nLowLimit=1\nHighLimit=0xFFFFFFFF\nDefaultValue=10000\nPDOMapping=0\n");
  const DeviceObject& it = object(file, 0x6085);
  EXPECT_EQ(it.name, "Quick stop deceleration");
  EXPECT_EQ(it.type, 7);
  EXPECT_EQ(it.access, DeviceObject::Access::kReadWrite);
  EXPECT_EQ(it.low, 1);
  EXPECT_EQ(it.high, 0xFFFFFFFF);
  EXPECT_EQ(it.value, 10000);
  EXPECT_FALSE(it.mappable);
  EXPECT_EQ(it.line, 9);
  EXPECT_TRUE(file.slips.empty()) << file.slips.front();
  EXPECT_EQ(file.vendor, "someone");
}

TEST(DeviceFile, ReadsRecordsByTheirSubIndices) {
  const DeviceFile file = parsed(
      "[60C2]\nObjectType=9\nSubNumber=2\n"
      "[60C2sub0]\nDataType=5\nAccessType=const\nDefaultValue=1\n"
      "[60C2sub1]\nDataType=5\nAccessType=rw\nDefaultValue=8\n");
  EXPECT_EQ(object(file, 0x60C2, 0).access, DeviceObject::Access::kConstant);
  EXPECT_EQ(object(file, 0x60C2, 1).value, 8);
  EXPECT_EQ(file.find(0x60C2, 2), nullptr);
  EXPECT_TRUE(file.has_index(0x60C2));
  EXPECT_FALSE(file.has_index(0x60C1));
}

TEST(DeviceFile, AMissingOrEmptyDefaultIsNone) {
  const DeviceFile file = parsed(
      "[6064]\nDataType=4\nAccessType=ro\n[6065]\nDataType=7\nAccessType=rw\nDefaultValue=\n");
  EXPECT_FALSE(object(file, 0x6064).value);
  EXPECT_FALSE(object(file, 0x6065).value);
}

TEST(DeviceFile, ReadsTheNodeInEveryForm) {
  int at = 0;
  for (const char* text : {"$NODEID+0x180", "0x180+$NODEID", "$NodeId + 0x180", "0X180 +$nodeid"}) {
    const DeviceFile file =
        parsed("[1800]\nDataType=7\nAccessType=rw\nDefaultValue=" + std::string(text) + "\n");
    EXPECT_TRUE(object(file, 0x1800).adds_node) << text;
    EXPECT_EQ(object(file, 0x1800).value, 0x180) << text;
    ++at;
  }
  EXPECT_EQ(at, 4);
  const DeviceFile alone = parsed("[2000]\nDataType=5\nAccessType=rw\nDefaultValue=$NODEID\n");
  EXPECT_EQ(object(alone, 0x2000).value, 0);
  EXPECT_TRUE(object(alone, 0x2000).adds_node);
  const DeviceFile sum =
      parsed("[1800]\nDataType=7\nAccessType=rw\nDefaultValue=0x40000000+0x180+$NODEID\n");
  EXPECT_EQ(object(sum, 0x1800).value, 0x40000180);
  EXPECT_TRUE(object(sum, 0x1800).adds_node);
}

TEST(DeviceFile, TakesHexAndNamesInAnyCase) {
  const DeviceFile file = parsed(
      "[60c1]\nobjecttype=0X9\nSUBNUMBER=1\n[60C1SUB01]\nDATATYPE=0X0004\nACCESSTYPE=RWW\n"
      "DEFAULTVALUE=0Xff\npdomapping=1\n");
  EXPECT_EQ(object(file, 0x60C1, 1).value, 0xFF);
  EXPECT_TRUE(object(file, 0x60C1, 1).mappable);
}

TEST(DeviceFile, TakesNamesWithBlanksWithAPrefixAndInQuotes) {
  const DeviceFile file = parsed(
      "[0x1018]\nObjectType=9\nSubNumber=1\n[1018 Sub 1]\nParameterName=\"Vendor\"\nDataType=7\n"
      "AccessType=\"ro\"\n");
  EXPECT_TRUE(file.slips.empty()) << file.slips.front();
  EXPECT_EQ(object(file, 0x1018, 1).name, "Vendor");
  EXPECT_EQ(object(file, 0x1018, 1).access, DeviceObject::Access::kReadOnly);
}

TEST(DeviceFile, ARecordNeedNotSayThatItIsOne) {
  const DeviceFile file = parsed("[1018]\nSubNumber=1\n[1018sub1]\nDataType=7\nAccessType=ro\n");
  EXPECT_TRUE(file.slips.empty()) << file.slips.front();
  EXPECT_NE(file.find(0x1018, 1), nullptr);
}

TEST(DeviceFile, ACompactMappingCanBeSwitchedOff) {
  const DeviceFile file = parsed(
      "[1600]\nObjectType=9\nDataType=7\nAccessType=rw\nCompactSubObj=2\n"
      "[1003]\nObjectType=8\nDataType=7\nAccessType=rw\nCompactSubObj=2\n");
  EXPECT_EQ(object(file, 0x1600, 0).access, DeviceObject::Access::kReadWrite);
  EXPECT_EQ(object(file, 0x1003, 0).access, DeviceObject::Access::kReadOnly);
}

TEST(DeviceFile, TakesBitsForWhatTheyAreInTheirType) {
  const DeviceFile file = parsed(
      "[607D]\nDataType=4\nAccessType=rw\nLowLimit=0x80000000\nHighLimit=0x7FFFFFFF\n"
      "DefaultValue=0xFFFFFFFF\n[6072]\nDataType=6\nAccessType=rw\nDefaultValue=-1\n");
  EXPECT_EQ(object(file, 0x607D).low, -2147483648LL);
  EXPECT_EQ(object(file, 0x607D).value, -1);
  EXPECT_EQ(object(file, 0x6072).value, 0xFFFF);
}

// An object that nobody asks for must not cost its user the whole file.
TEST(DeviceFile, AValueThatIsNoneOfItsTypeIsNotGivenAndSaid) {
  struct Case {
    const char* line;
    const char* slip;
  };
  for (const Case& it :
       {Case{"DefaultValue=0x10000000",
             "value = 0x10000000 does not fit the 16 bits of its data type"},
        Case{"DefaultValue=0.5", "value = 0.5 is no number, nor $NODEID and one"},
        Case{"DefaultValue=$NODEID*2", "value = $NODEID*2 is no number, nor $NODEID and one"},
        Case{"HighLimit=n/a", "value = n/a is no number, nor $NODEID and one"},
        Case{"LowLimit=-70000", "value = -70000 does not fit the 16 bits of its data type"},
        Case{"LowLimit=-9223372036854775808",
             "value = -9223372036854775808 does not fit the 16 bits of its data type"}}) {
    const DeviceFile file =
        parsed("[6072]\nDataType=6\nAccessType=rw\n" + std::string(it.line) + "\n");
    EXPECT_FALSE(object(file, 0x6072).value) << it.line;
    EXPECT_FALSE(object(file, 0x6072).low) << it.line;
    EXPECT_FALSE(object(file, 0x6072).high) << it.line;
    EXPECT_FALSE(object(file, 0x6072).adds_node) << it.line;
    ASSERT_EQ(file.slips.size(), 1u) << it.line;
    EXPECT_EQ(file.slips[0], "a.eds:12: [6072] " + std::string(it.slip) + "; taken as not given");
  }
}

TEST(DeviceFile, TakesACommentBehindAValueForOne) {
  const DeviceFile file = parsed(
      "[6072]\nObjectType=0x7 ; VAR\nDataType=0x0006 ; UNSIGNED16\nAccessType=rw ;both ways\n"
      "DefaultValue=$NODEID+0x180 ; as shipped\nLowLimit=;none\nHighLimit=1000; per mille\n");
  EXPECT_TRUE(file.slips.empty()) << file.slips.front();
  EXPECT_EQ(object(file, 0x6072).value, 0x180);
  EXPECT_EQ(object(file, 0x6072).high, 1000);
  EXPECT_FALSE(object(file, 0x6072).low);
}

TEST(DeviceFile, TakesOctalAsItsStandardDoes) {
  EXPECT_EQ(object(parsed("[2000]\nDataType=5\nAccessType=rw\nDefaultValue=010\n"), 0x2000).value,
            8);
  EXPECT_EQ(object(parsed("[2000]\nDataType=5\nAccessType=rw\nDefaultValue=08\n"), 0x2000).value,
            8);
}

TEST(DeviceFile, UnfoldsCompactSubObjects) {
  const DeviceFile file = parsed(
      "[1003]\nParameterName=Errors\nObjectType=8\nDataType=7\nAccessType=ro\nCompactSubObj=3\n"
      "[1003Value]\nNrOfEntries=1\n2=0x10\n");
  EXPECT_EQ(object(file, 0x1003, 0).value, 3);
  EXPECT_EQ(object(file, 0x1003, 0).type, 5);
  EXPECT_FALSE(object(file, 0x1003, 1).value);
  EXPECT_EQ(object(file, 0x1003, 2).value, 0x10);
  EXPECT_EQ(object(file, 0x1003, 3).access, DeviceObject::Access::kReadOnly);
  EXPECT_EQ(file.find(0x1003, 4), nullptr);
  EXPECT_EQ(refused("[1003]\nObjectType=8\nDataType=7\nAccessType=ro\nCompactSubObj=255\n"),
            "a.eds:13: [1003] CompactSubObj = 255, must be in [0, 254]");
}

TEST(DeviceFile, DoubleSectionsThatAgreeAreOneAndSaid) {
  const DeviceFile file =
      parsed("[6064]\nDataType=4\nAccessType=ro\n[6064]\nDataType=4\nPDOMapping=1\n");
  EXPECT_TRUE(object(file, 0x6064).mappable);
  ASSERT_EQ(file.slips.size(), 1u);
  EXPECT_EQ(file.slips[0],
            "a.eds:12: section [6064] stands in line 9 already; both are read as one");
}

TEST(DeviceFile, DoublesThatContradictEachOtherAreRefused) {
  EXPECT_EQ(refused("[6064]\nDataType=4\nAccessType=ro\n[6064]\nDataType=7\n"),
            "a.eds:13: [6064] datatype = 7 contradicts line 10, which says 4; remove one of them");
}

TEST(DeviceFile, DoublesOfOneNumberAgree) {
  const DeviceFile file = parsed(
      "[6066]\nObjectType=0x7\nDataType=0x0006\nAccessType=rw\nDefaultValue=0xFB\n"
      "[6066]\nObjectType=7\nDefaultValue=251 ; ms\n");
  EXPECT_EQ(object(file, 0x6066).value, 251);
}

TEST(DeviceFile, SaysWhichWayProcessDataGoes) {
  const auto of = [](const std::string& access, int mapping) {
    return object(parsed("[607A]\nDataType=4\nAccessType=" + access +
                         "\nPDOMapping=" + std::to_string(mapping) + "\n"),
                  0x607A);
  };
  for (const char* access : {"rw", "rww", "wo"}) EXPECT_TRUE(of(access, 1).goes_into_rpdo());
  for (const char* access : {"ro", "rwr", "const"}) EXPECT_FALSE(of(access, 1).goes_into_rpdo());
  for (const char* access : {"rw", "rwr", "ro"}) EXPECT_TRUE(of(access, 1).goes_into_tpdo());
  for (const char* access : {"rww", "wo"}) EXPECT_FALSE(of(access, 1).goes_into_tpdo());
  EXPECT_FALSE(of("rw", 0).goes_into_rpdo());
  EXPECT_FALSE(of("rw", 0).goes_into_tpdo());
}

TEST(DeviceFile, ReadsWhichGapsAMappingMayHave) {
  EXPECT_FALSE(parsed("[1000]\nDataType=7\nAccessType=ro\n").dummies);
  const DeviceFile file = parsed(
      "[DummyUsage]\nDummy0001=0\nDummy0004=1\nDummy0007=1\n[1000]\nDataType=7\nAccessType=ro\n");
  EXPECT_EQ(file.dummies, 0b1001'0000);
}

TEST(DeviceFile, ALimitThatIsNoneIsSaid) {
  const auto slip_of = [](const std::string& limit) {
    const DeviceFile file = parsed("[605A]\nDataType=3\nAccessType=rw\n" + limit + "\n");
    EXPECT_FALSE(object(file, 0x605A).high);
    return file.slips.empty() ? "" : file.slips.front();
  };
  EXPECT_EQ(slip_of("HighLimit=$NODEID+0x200"),
            "a.eds:12: [605A] highlimit = $NODEID+0x200 depends on the node, which limits do not; "
            "there is no such limit");
  for (const char* all : {"HighLimit=65535", "HighLimit=0xFFFF"}) {
    EXPECT_NE(slip_of(all).find("is negative in its data type; there is no such limit"),
              std::string::npos);
  }
  const DeviceFile file = parsed("[605A]\nDataType=3\nAccessType=rw\nHighLimit=-1\n");
  EXPECT_EQ(object(file, 0x605A).high, -1);
}

TEST(DeviceFile, SaysThatPdosWithoutSectionsAreNotRead) {
  const DeviceFile file = parse_device_file(
      "a.eds", "[DeviceInfo]\nCompactPDO=0x1F\n[1000]\nDataType=7\nAccessType=ro\n");
  ASSERT_FALSE(file.slips.empty());
  EXPECT_EQ(file.slips.front().rfind("a.eds:2: CompactPDO describes PDOs without sections", 0), 0U)
      << file.slips.front();
}

TEST(DeviceFile, OfMoreSlipsThanAnybodyReadsItSaysHowMany) {
  std::string sections;
  for (int i = 0; i < 300; ++i) sections += format("[%04X]\nObjectType=7\n", 0x2000 + i);
  const DeviceFile file = parsed(sections + "[1000]\nDataType=7\nAccessType=ro\n");
  ASSERT_EQ(file.slips.size(), 201U);
  EXPECT_EQ(file.slips.back(), "a.eds: and 100 slips more");
}

TEST(DeviceFile, OfDoublesThatDecideNothingTheFirstIsTaken) {
  const DeviceFile file = parsed(
      "[6064]\nParameterName=Position\nDataType=4\nAccessType=ro\n[6064]\nParameterName=Actual\n");
  EXPECT_EQ(object(file, 0x6064).name, "Position");
  ASSERT_EQ(file.slips.size(), 2u);
  EXPECT_EQ(file.slips[1],
            "a.eds:14: [6064] parametername = Actual contradicts line 10, which says Position; the "
            "first is taken");
}

TEST(DeviceFile, ASubIndexThatIsDescribedTwiceIsReadOnce) {
  const DeviceFile file = parsed(
      "[1018]\nObjectType=9\nSubNumber=1\n[1018sub01]\nDataType=7\nAccessType=ro\n"
      "[1018sub1]\nDataType=5\nAccessType=rw\n");
  EXPECT_EQ(object(file, 0x1018, 1).type, 7);
  ASSERT_EQ(file.slips.size(), 1u);
  EXPECT_EQ(file.slips[0], "a.eds:15: [1018sub1] is described already; ignored");
}

TEST(DeviceFile, WhatAListNamesAndNobodyDescribesIsMissingAndSaid) {
  const DeviceFile file = parse_device_file(
      "a.eds", "[OptionalObjects]\n1=0x6007\n2=0x6064\n[6064]\nDataType=4\nAccessType=ro\n");
  EXPECT_EQ(file.find(0x6007, 0), nullptr);
  const auto said = [&](const std::string& line) {
    return std::find(file.slips.begin(), file.slips.end(), line) != file.slips.end();
  };
  EXPECT_TRUE(
      said("a.eds:2: [OptionalObjects] lists 0x6007, which no section describes; taken as "
           "missing"));
  EXPECT_TRUE(said("a.eds:1: has no section [DeviceInfo]"));
}

TEST(DeviceFile, CountsSubIndicesThatAreThere) {
  const DeviceFile file = parsed(
      "[1600]\nObjectType=9\nSubNumber=9\n[1600sub0]\nDataType=5\nAccessType=rw\nDefaultValue=1\n"
      "[1600sub1]\nDataType=7\nAccessType=rw\n");
  EXPECT_NE(file.find(0x1600, 1), nullptr);
  ASSERT_EQ(file.slips.size(), 1u);
  EXPECT_EQ(file.slips[0],
            "a.eds:9: [1600] SubNumber = 9, but 2 sub-indices are described; those are taken");
}

TEST(DeviceFile, MissingTypeOrAccessIsSaid) {
  const DeviceFile file = parsed("[2000]\nAccessType=rw\n[2001]\nDataType=5\n");
  EXPECT_EQ(file.find(0x2000, 0), nullptr);
  EXPECT_EQ(object(file, 0x2001).access, DeviceObject::Access::kReadWrite);
  ASSERT_EQ(file.slips.size(), 2u);
  EXPECT_EQ(file.slips[0], "a.eds:9: [2000] lacks DataType; taken as missing");
  EXPECT_EQ(file.slips[1], "a.eds:11: [2001] lacks AccessType; taken as rw");
}

TEST(DeviceFile, OtherSlipsAreRefusedByFileAndLine) {
  EXPECT_EQ(refused("[2000]\nDataType=five\nAccessType=rw\n"),
            "a.eds:10: [2000] datatype = five, must be a number such as 8, 0x6040 or 010");
  EXPECT_EQ(refused("[2000]\nDataType=5\nAccessType=both\n"),
            "a.eds:11: [2000] AccessType = both, must be one of ro, wo, rw, rwr, rww, const");
  EXPECT_EQ(refused("[2000\nDataType=5\n"), "a.eds:9: [2000 lacks its ]");
  EXPECT_EQ(tests::refusal([] { (void)parse_device_file("a.eds", "\xFF\xFE[\0"); }),
            "a.eds:1: is in UTF-16; save it as plain text (ASCII or UTF-8)");
  EXPECT_EQ(refused(""), "a.eds:1: describes no object; is it an EDS or DCF file?");
}

TEST(DeviceFile, TakesAnyEndOfLineCommentsAndAByteOrderMark) {
  const DeviceFile file = parse_device_file(
      "a.eds",
      "\xEF\xBB\xBF; a comment\r\n[6064]\r\nDataType=0x4\r\rAccessType = ro \n# another\n");
  EXPECT_EQ(object(file, 0x6064).access, DeviceObject::Access::kReadOnly);
}

TEST(DeviceFile, ADcfHasItsNodeAndItsOwnValues) {
  const DeviceFile file = parsed(
      "[DeviceComissioning]\nNodeID=5\n[6065]\nDataType=7\nAccessType=rw\nDefaultValue=1\n"
      "ParameterValue=2\n");
  EXPECT_EQ(file.node, 5);
  EXPECT_EQ(object(file, 0x6065).value, 2);
  EXPECT_EQ(refused("[DeviceCommissioning]\nNodeID=128\n[6065]\nDataType=7\n"),
            "a.eds:9: NodeID = 128, must be in [1, 127]");
  const DeviceFile unset =
      parsed("[DeviceComissioning]\nNodeID=0\n[6065]\nDataType=7\nAccessType=rw\n");
  EXPECT_FALSE(unset.node);
  ASSERT_EQ(unset.slips.size(), 1u);
  EXPECT_EQ(unset.slips[0], "a.eds:9: NodeID = 0 is no node's; taken as not set");
}

TEST(DeviceFile, TheTwinsOfTheTestsHaveNoSlip) {
  for (const char* name : {"tests/twins/lwa4p.eds", "tests/twins/epos4.eds"}) {
    const DeviceFile file = parse_device_file(name, config::read_file(tests::in_tree(name)));
    EXPECT_TRUE(file.slips.empty()) << file.slips.front();
    EXPECT_EQ(object(file, 0x6041).access, DeviceObject::Access::kReadOnly);
  }
}

}  // namespace
}  // namespace tenon
