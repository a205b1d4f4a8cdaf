#include <waymark/tools/inspection/survey/field_forms.hpp>

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>

#include <waymark/formats/logs/detail/common/table_accuracy.hpp>
#include <waymark/formats/logs/detail/csv/table_angle.hpp>
#include <waymark/formats/logs/detail/csv/table_time.hpp>

namespace waymark::inspection {
namespace {

/// What a column of a form is: a quantity, or an angle whose quantity the name tells.
enum class Meaning { instant, date, time_of_day, hemisphere, angle, quality };

struct Form {
  Meaning meaning;
  std::string_view unit;
  std::string_view quantity;
};

// The first of several forms that fit is proposed: decimal degrees before ddmm.mmmm, day before month.
constexpr std::array kForms{
    Form{Meaning::instant, "iso8601", "time"},
    Form{Meaning::instant, "dmy", "time"},
    Form{Meaning::instant, "mdy", "time"},
    Form{Meaning::date, "iso8601", "date"},
    Form{Meaning::date, "dmy", "date"},
    Form{Meaning::date, "mdy", "date"},
    Form{Meaning::time_of_day, "hms", "time"},
    Form{Meaning::hemisphere, "ns", "latitude_hemisphere"},
    Form{Meaning::hemisphere, "ew", "longitude_hemisphere"},
    Form{Meaning::angle, "deg", ""},
    Form{Meaning::angle, "ddmm", ""},
    Form{Meaning::angle, "dms", ""},
    Form{Meaning::quality, "", "quality"},
};

bool is_of_axis(std::string_view field, std::string_view axis) {
  if (field.size() != 1 || !formats::hemisphere_from_field(field)) return false;
  const bool north_south = field == "N" || field == "S" || field == "n" || field == "s";
  return north_south == (axis == "ns");
}

/// A month by name leaves one order only, which the readers find under any; it counts as day before month.
bool names_month(std::string_view field) {
  const std::string_view date = field.substr(0, field.find(' '));
  return std::any_of(date.begin(), date.end(), [](unsigned char c) { return std::isalpha(c) != 0; });
}

bool has_form(std::string_view field, const Form& form) {
  if (form.unit == "mdy" && names_month(field)) return false;
  switch (form.meaning) {
    case Meaning::instant:
    case Meaning::time_of_day:
      return formats::instant_from_field(field, form.unit, 0).has_value();
    case Meaning::date:
      return formats::date_from_field(field, form.unit).has_value();
    case Meaning::hemisphere:
      return is_of_axis(field, form.unit);
    case Meaning::angle: {
      const std::optional<double> angle = formats::angle_from_field(field, form.unit);
      return angle && *angle >= -180 && *angle <= 360;
    }
    case Meaning::quality:
      return formats::table_quality(field, "").has_value();
  }
  return false;
}

const Form* first_form(FieldForms forms) {
  for (std::size_t i = 0; i < kForms.size(); ++i)
    if ((forms >> i & 1U) != 0) return &kForms[i];
  return nullptr;
}

bool has_unit(FieldForms forms, Meaning meaning, std::string_view unit) {
  for (std::size_t i = 0; i < kForms.size(); ++i)
    if ((forms >> i & 1U) != 0 && kForms[i].meaning == meaning && kForms[i].unit == unit) return true;
  return false;
}

}  // namespace

FieldForms forms_of(std::string_view field, FieldForms among) {
  FieldForms found = 0;
  for (std::size_t i = 0; i < kForms.size(); ++i)
    if ((among >> i & 1U) != 0 && has_form(field, kForms[i])) found |= FieldForms{1} << i;
  return found;
}

bool holds_instants(FieldForms forms) {
  const Form* form = first_form(forms);
  return form != nullptr && (form->meaning == Meaning::instant || form->meaning == Meaning::time_of_day);
}

double instant_seconds(std::string_view field, FieldForms forms) {
  const Form* form = first_form(forms);
  const auto instant = form == nullptr ? std::nullopt : formats::instant_from_field(field, form->unit, 0);
  return instant ? instant->stamp.seconds() : 0;
}

ColumnProposal proposal_of_forms(FieldForms forms, const ColumnProposal& by_name) {
  const Form* form = first_form(forms);
  if (form == nullptr) return {};
  ColumnProposal proposal = by_name;
  const bool is_angle = by_name.quantity == "latitude" || by_name.quantity == "longitude";
  switch (form->meaning) {
    case Meaning::angle:
      if (!is_angle) return {};
      proposal.unit = form->unit;
      return proposal;
    case Meaning::quality:
      return by_name.quantity == "quality" ? ColumnProposal{"quality", "", "", true, ""} : ColumnProposal{};
    case Meaning::hemisphere:
      return {std::string(form->quantity), "", "", true, ""};
    case Meaning::instant:
    case Meaning::date:
    case Meaning::time_of_day:
      break;
  }
  if (by_name.quantity != form->quantity)
    proposal = {
        std::string(form->quantity), "", "", false,
        by_name.quantity.empty() && form->meaning == Meaning::instant ? "the column holds dates" : ""};
  proposal.unit = form->unit;
  proposal.unit_known = true;
  if (form->unit == "dmy" && has_unit(forms, form->meaning, "mdy"))
    proposal.remark =
        "day before month is assumed; every date here can also be read with the month first (mdy)";
  return proposal;
}

}  // namespace waymark::inspection
