//! The report: one HTML file with every verdict, number and figure in it.

use std::fmt::Write;

use super::claim::{Claim, Verdict};
use super::{Findings, Summary};

const STYLE: &str = "body{font:15px/1.5 system-ui,sans-serif;color:#222;max-width:1440px;margin:2em auto;padding:0 1.5em}\
h1,h2{line-height:1.2}table{border-collapse:collapse;width:100%;margin:1em 0}\
td,th{border-bottom:1px solid #ddd;padding:.5em .7em;text-align:left;vertical-align:top}\
th{background:#f5f5f5}.reproduced{color:#00735a}.not_reproduced{color:#b03a00}.cannot_be_judged{color:#666}\
p.advice{border-left:4px solid #0072b2;padding-left:1em}td.verdict{font-weight:600;white-space:nowrap}figure{margin:2em 0}figure svg{max-width:100%;height:auto}\
figcaption,.small{color:#555;font-size:.92em}";

/// The report's text; `pictures` are the SVG documents of all figures in order.
pub fn html(findings: &[Findings], pictures: &[String]) -> String {
    let mut page = String::new();
    let mut pictures = pictures.iter();
    // Writing to a string cannot fail.
    let _ = write!(
        page,
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>Reproduction report</title>\
         <style>{STYLE}</style></head><body>\n<h1>What the papers claim and what the models do</h1>\n\
         <p>Every number below was computed by maglev-fmu {} from runs of the packaged models; every verdict follows \
         from its number by the stated criterion.</p>\n",
        env!("CARGO_PKG_VERSION")
    );
    for experiment in findings {
        let _ = writeln!(page, "<h2>{}</h2>", escape(experiment.title));
        for paragraph in experiment.provenance {
            let _ = writeln!(page, "<p>{}</p>", escape(paragraph));
        }
        for paragraph in &experiment.advice {
            let _ = writeln!(page, "<p class=\"advice\">{}</p>", escape(paragraph));
        }
        experiment.summaries.iter().for_each(|summary| table(&mut page, summary));
        page.push_str(
            "<table><tr><th>Claim</th><th>Verdict</th><th>Measured</th><th>How it was judged</th></tr>\n",
        );
        experiment.claims.iter().for_each(|claim| row(&mut page, claim));
        page.push_str("</table>\n");
        for (figure, picture) in experiment.figures.iter().zip(pictures.by_ref()) {
            let _ = writeln!(
                page,
                "<figure id=\"{}\">{picture}<figcaption>{} Data: {}.csv.</figcaption></figure>",
                figure.name,
                escape(&figure.figure.caption),
                figure.name
            );
        }
    }
    page.push_str("</body></html>\n");
    page
}

fn table(page: &mut String, summary: &Summary) {
    let cells = |tag: &str, cells: &[String]| -> String {
        cells.iter().map(|cell| format!("<{tag}>{}</{tag}>", escape(cell))).collect()
    };
    let _ =
        write!(page, "<h3>{}</h3><table><tr>{}</tr>", escape(&summary.title), cells("th", &summary.headers));
    for row in &summary.rows {
        let _ = write!(page, "<tr>{}</tr>", cells("td", row));
    }
    page.push_str("</table>\n");
}

fn row(page: &mut String, claim: &Claim) {
    let class = match claim.verdict {
        Verdict::Reproduced => "reproduced",
        Verdict::NotReproduced => "not_reproduced",
        Verdict::CannotBeJudged => "cannot_be_judged",
    };
    let _ = write!(
        page,
        "<tr id=\"{}\"><td>{}<div class=\"small\">{}</div></td><td class=\"verdict {class}\">{}</td><td>",
        claim.id,
        escape(&claim.statement),
        claim.source,
        claim.verdict.text()
    );
    for measurement in &claim.measured {
        let _ = write!(
            page,
            "<div>{}: {}</div>",
            escape(&measurement.what),
            quantity(measurement.value, measurement.unit)
        );
    }
    let _ = writeln!(page, "</td><td class=\"small\">{}</td></tr>", escape(&claim.criterion));
}

/// Number with unit; three to four significant digits.
pub fn quantity(value: f64, unit: &str) -> String {
    let magnitude = value.abs();
    let number = if value == 0.0 {
        "0".to_owned()
    } else if (1e-3..1e5).contains(&magnitude) {
        let decimals = (3 - magnitude.log10().floor() as i32).clamp(0, 6) as usize;
        let text = format!("{value:.decimals$}");
        if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
    } else {
        // Mantissa without trailing zeros.
        let text = format!("{value:.2e}");
        let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
        format!("{}e{exponent}", mantissa.trim_end_matches('0').trim_end_matches('.'))
    };
    if unit == "1" { number } else { format!("{number} {unit}") }
}

fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantities_are_rounded_for_people() {
        assert_eq!(quantity(0.0, "m"), "0 m");
        assert_eq!(quantity(150.0, "V"), "150 V");
        assert_eq!(quantity(0.0123456, "m"), "0.01235 m");
        assert_eq!(quantity(1.234e-7, "Wb"), "1.23e-7 Wb");
        assert_eq!(quantity(1e-9, "m"), "1e-9 m");
        assert_eq!(quantity(3.0, "1"), "3");
    }

    #[test]
    fn text_cannot_break_the_page() {
        assert_eq!(escape("|u| < 150 & <b>"), "|u| &lt; 150 &amp; &lt;b&gt;");
    }
}
