//! `docs/operators.md`: measured units beside the best public cores.

use serde::Deserialize;

use super::synth::by;
use super::table::figure;
use crate::synth::Figures;

/// The figures of public cores on the same flow.
#[derive(Debug, Deserialize)]
struct PublicCores {
    flow: String,
    cores: Vec<Core>,
}

/// One public core. Figures as in [`Figures`].
#[derive(Debug, Deserialize)]
struct Core {
    core: String,
    unit: String,
    abilities: String,
    cycles: u32,
    luts: u64,
    ffs: u64,
    dsps: u64,
    clock_mhz: f64,
    latency_ns: f64,
    /// True for the core that ours is compared with: the best at high clocks among those with the same abilities.
    #[serde(default)]
    best: bool,
}

const HEADING: &str =
    "| unit | abilities | cut for | cycles | MHz | ns | LUT | FF | DSP | BRAM | ns to public | LUT to public |
|---|---|---|---|---|---|---|---|---|---|---|---|
";

/// The page with the given figures, which may be in any order.
///
/// # Errors
/// Returns an error only if this program was built with a faulty list of public cores.
pub fn page(all: &[Figures]) -> Result<String, serde_json::Error> {
    let public: PublicCores = serde_json::from_str(include_str!("public_cores.json"))?;
    let mut out = String::from("# Operators, placed and routed\n\n");
    out += "`scripts/operators` makes this page: it runs `afu synth` and passes the JSON to `afu synth --page`.\n\n\
            - Our operators: LFE5U-85F, speed grade 8, median clock over the seeds. The wrapper's cells are subtracted.\n\
            - Public cores: ";
    out += &public.flow;
    out += "\n- Ratios compare our operator with the public core marked *. Below 1, ours is better.\n\nAbove about 200 MHz, a clock \
            limited by a registered multiplier block comes from the tool's model, not from the device: nextpnr does \
            not time the path inside the block.\n";
    let mut units: Vec<&str> = Vec::new();
    for figures in all {
        if !units.contains(&figures.unit.as_str()) {
            units.push(&figures.unit);
        }
    }
    for unit in units {
        out += &format!("\n## {unit}\n\n{HEADING}");
        let family = if unit == "recip" {
            "div"
        } else if unit == "sub" {
            "add"
        } else {
            unit
        };
        let cores = || public.cores.iter().filter(|core| core.unit == family);
        for figures in all.iter().filter(|figures| figures.unit == unit) {
            out += &ours(figures, cores().filter(|core| core.best));
        }
        for core in cores() {
            out += &format!(
                "| {}{} | {} | | {} | {:.0} | {:.0} | {} | {} | {} | 0 | | |\n",
                core.core,
                if core.best { " *" } else { "" },
                core.abilities,
                core.cycles,
                core.clock_mhz,
                core.latency_ns,
                core.luts,
                core.ffs,
                core.dsps
            );
        }
        for figures in all.iter().filter(|figures| figures.unit == unit && !figures.critical.is_empty()) {
            let mut names: Vec<&str> = figures.critical.iter().map(|hop| hop.signal.as_str()).collect();
            names.dedup();
            out += &format!(
                "\nCritical path of {} {}{} cut for {} MHz: `{}`.\n",
                unit,
                figures.profile,
                by(figures),
                figures.asked_mhz,
                names.join("` → `")
            );
        }
    }
    Ok(out)
}

fn ours<'a>(figures: &Figures, best: impl Iterator<Item = &'a Core>) -> String {
    let format = figures.profile.format();
    let subnormals = format.keeps_subnormals();
    // A core with the same abilities if there is one, otherwise any.
    let mut best: Vec<&Core> = best.collect();
    best.sort_by_key(|core| core.abilities.starts_with("IEEE") != subnormals);
    let ratio = |ours: Option<f64>, public: fn(&Core) -> f64| {
        figure(ours.zip(best.first()).map(|(ours, core)| ours / public(core)), 2)
    };
    let met = match figures.meets() {
        Some(true) => "",
        Some(false) => " (missed)",
        None => " (not routed)",
    };
    format!(
        "| **{} {}{}** | {format}, {} | {:.0}{met} | {} | {} | {} | {} | {} | {} | {} | {} | {} |\n",
        figures.unit,
        figures.profile,
        by(figures),
        if subnormals { "subnormals" } else { "no subnormals" },
        figures.asked_mhz,
        figures.latency_cycles.map_or_else(|| "-".to_owned(), |cycles| cycles.to_string()),
        figure(figures.clock_mhz, 0),
        figure(figures.latency_ns, 1),
        figures.area.luts,
        figures.area.ffs,
        figures.area.dsps,
        figures.area.brams,
        ratio(figures.latency_ns, |core| core.latency_ns),
        ratio(Some(figures.area.luts as f64), |core| core.luts as f64)
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_family_has_a_core_to_be_compared_with() {
        let public: PublicCores = serde_json::from_str(include_str!("public_cores.json")).expect("as committed");
        for unit in ["add", "mul", "div", "sqrt", "scpu"] {
            assert!(public.cores.iter().any(|core| core.unit == unit && core.best), "{unit}");
        }
        // The list says that latency is cycles over clock. Both are rounded to whole numbers.
        for core in &public.cores {
            let ns = 1000.0 * f64::from(core.cycles) / core.clock_mhz;
            assert!((ns - core.latency_ns).abs() < 0.02 * ns + 0.6, "{}: {ns:.1}", core.core);
        }
    }
}
