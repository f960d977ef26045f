// XML as 3MF, AMF and COLLADA have it: events in closed form, damaged documents, encodings.
#include "bake/import/import_xml.h"

#include <gtest/gtest.h>

#include <span>

namespace relief::test {
namespace {

using Event = XmlReader::Event;

/// "<a>", "</a>" and text, one after the other; of an error its message.
std::string eventsOf(const std::string& document) {
    XmlReader xml(std::as_bytes(std::span(document)));
    std::string events;
    for (;;) {
        const Result<Event> event = xml.next();
        if (!event) {
            return event.error().message;
        }
        switch (*event) {
            case Event::kDone:
                return events;
            case Event::kBegin:
                events += "<" + std::string(xml.name());
                for (const XmlReader::Attribute& attribute : xml.attributes()) {
                    events += " " + std::string(attribute.name) + "=" + attribute.value;
                }
                events += ">";
                break;
            case Event::kEnd:
                events += "</" + std::string(xml.name()) + ">";
                break;
            case Event::kText:
                events += xml.text();
        }
    }
}

TEST(ImportXml, EventsFollowTheDocument) {
    EXPECT_EQ(eventsOf("<a/>"), "<a></a>");
    EXPECT_EQ(
        eventsOf(
            "<?xml version='1.0'?>\n<!DOCTYPE a [<!ELEMENT a (b)> <!-- > -->]>\n<a><!-- <b> --><b c = 'd' "
            "\n e=\"f'\"/>1<c>2</c >\r\n</a>\n"),
        "<a><b c=d e=f'></b>1<c>2</c></a>");
    EXPECT_EQ(eventsOf("<p:a x='&lt;&#65;&#x42;&amp;'>&gt;<![CDATA[<&>]]></p:a>"), "<a x=<AB&>><&></a>");
    EXPECT_EQ(eventsOf("<a>&#xE4;&#x1F600;</a>"), "<a>\xc3\xa4\xf0\x9f\x98\x80</a>");
}

TEST(ImportXml, PathsAndAttributesHaveNoPrefixes) {
    const std::string document = "<m:model unit='inch' xmlns:path='u'><m:item p:path='/x'/></m:model>";
    XmlReader xml(std::as_bytes(std::span(document)));
    ASSERT_EQ(xml.next(), Event::kBegin);
    EXPECT_TRUE(xml.at({"model"}));
    EXPECT_EQ(xml.attribute("unit"), "inch");
    EXPECT_FALSE(xml.attribute("path")) << "a namespace";
    ASSERT_EQ(xml.next(), Event::kBegin);
    EXPECT_TRUE(xml.at({"model", "item"}));
    EXPECT_FALSE(xml.at({"item"}));
    EXPECT_EQ(xml.attribute("path"), "/x");
    EXPECT_EQ(xml.depth(), 2U);
}

TEST(ImportXml, DamageIsToldWithItsLine) {
    for (const char* document : {"",
                                 " ",
                                 "<",
                                 "<a",
                                 "<a>",
                                 "<a b>",
                                 "<a b=c/>",
                                 "<a b='c/>",
                                 "<a></b>",
                                 "</a>",
                                 "<a/><b/>",
                                 "<a/>x",
                                 "x<a/>",
                                 "<a>&x;</a>",
                                 "<a>&#0;</a>",
                                 "<a>&#x110000;</a>",
                                 "<a>&#99999999999999999999;</a>",
                                 "<a>&amp</a>",
                                 "<!-- <a/>",
                                 "<a><![CDATA[x</a>",
                                 "<?xml <a/>",
                                 "<!DOCTYPE a [<a/>",
                                 "< a/>",
                                 "<a><b></a></b>"}) {
        const std::string message = eventsOf(document);
        EXPECT_TRUE(message.starts_with("its XML is damaged: line ")) << document << " -> " << message;
    }
    EXPECT_NE(eventsOf("<a>\n\n<b>\n</a>").find("line 4: "), std::string::npos);
    EXPECT_NE(eventsOf("<a>\n<b>").find("cut off"), std::string::npos);
}

TEST(ImportXml, EveryTruncationIsDamage) {
    const std::string document =
        "<?xml version='1.0'?><a b='c'><!-- d --><e>f&amp;g</e><![CDATA[h]]><i/></a>";
    ASSERT_EQ(eventsOf(document), "<a b=c><e>f&g</e>h<i></i></a>");
    for (std::size_t size = 0; size < document.size(); ++size) {
        EXPECT_TRUE(eventsOf(document.substr(0, size)).starts_with("its XML is damaged")) << size;
    }
}

TEST(ImportXml, EncodingsBecomeUtf8) {
    using namespace std::string_literals;
    EXPECT_EQ(eventsOf("\xff\xfe<\0a\0/\0>\0"s), "<a></a>");
    EXPECT_EQ(eventsOf("\xfe\xff\0<\0a\0/\0>"s), "<a></a>");
    EXPECT_EQ(eventsOf("<\0a\0>\0\xe4\0\x3d\xd8\0\xde<\0/\0a\0>\0"s), "<a>\xc3\xa4\xf0\x9f\x98\x80</a>");
    EXPECT_TRUE(eventsOf("<\0a\0>\0\x3d\xd8<\0/\0a\0>\0"s).starts_with("its XML is damaged"))
        << "half a pair";
    EXPECT_EQ(eventsOf("\xef\xbb\xbf<a/>"), "<a></a>");
    EXPECT_EQ(eventsOf("<?xml version='1.0' encoding='windows-1252'?><a>\xe4</a>"), "<a>\xc3\xa4</a>");
}

TEST(ImportXml, EntitiesOfADocumentsOwnAreRefused) {
    EXPECT_NE(eventsOf("<!DOCTYPE a [<!ENTITY b 'c'>]><a>&b;</a>").find("'b' is no character"),
              std::string::npos);
    EXPECT_NE(eventsOf("<!DOCTYPE a SYSTEM 'a.dtd'><a>&b;</a>").find("'b' is no character"),
              std::string::npos);
}

}  // namespace
}  // namespace relief::test
