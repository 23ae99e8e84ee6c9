//! Breaks long lines where a person would: at assignments, branches, operators and elements.
//!
//! It works on text, so it holds for all that is printed. Operators between operands have a space on either side.

/// The longest line of a file.
const WIDTH: usize = 120;
/// An operand or element of at most this many characters shares a line with others.
const SHORT: usize = 36;
/// Conditions of a ladder are aligned if none is longer than this.
const ALIGNED: usize = 40;
/// A conditional with this many conditions has a line for each, however short it is.
const LADDER: usize = 3;
/// Operators, those that bind least first.
const OPERATORS: [&[&str]; 10] =
    [&["||"], &["&&"], &["|"], &["^"], &["&"], &["==", "!="], &["<", ">=", ">"], &["<<"], &["+", "-"], &["*", "/"]];

/// The text with every line broken that is longer than [`WIDTH`].
pub(super) fn lay_out(text: &str) -> String {
    let mut out = String::with_capacity(text.len() + text.len() / 8);
    for line in text.lines() {
        let body = line.trim_start();
        let indent = line.len() - body.len();
        let is_long = line.len() > WIDTH;
        if let Some(comment) = body.strip_prefix("// ") {
            out += &if is_long { comment_lines(comment, indent) } else { line.to_owned() };
        } else if is_long || is_ladder(body) {
            out += &format!("{:indent$}{}", "", statement(body, indent));
        } else {
            out += line;
        }
        out.push('\n');
    }
    out
}

fn comment_lines(comment: &str, indent: usize) -> String {
    let start = format!("{:indent$}//", "");
    let mut lines = vec![start.clone()];
    for word in comment.split(' ') {
        match lines.last_mut().filter(|last| last.len() + 1 + word.len() <= WIDTH || **last == start) {
            Some(last) => *last += &format!(" {word}"),
            None => lines.push(format!("{start} {word}")),
        }
    }
    lines.join("\n")
}

fn is_ladder(body: &str) -> bool {
    let value = assignment(body).map(|(_, value)| value);
    value.is_some_and(|value| value.contains(" ? ") && rungs(value).0.len() >= LADDER)
}

/// The two sides of an assignment, the left one with its sign.
fn assignment(body: &str) -> Option<(&str, &str)> {
    let is_sign = |at: &usize| body[*at..].starts_with(" <= ") || body[*at..].starts_with(" = ");
    let at = outside(body).find(is_sign)?;
    let end = at + body[at..].find("= ")? + 1;
    Some((&body[..end], &body[end + 1..]))
}

fn statement(body: &str, indent: usize) -> String {
    let Some((left, value)) = assignment(body) else { return expression(body, indent, 0) };
    let (value, tail) = value.strip_suffix(';').map_or((value, ""), |value| (value, ";"));
    // A long condition before the assignment has lines of its own.
    let (mut head, mut inner, mut target) = (String::new(), indent, left);
    if let Some((condition, rest)) = condition(left).filter(|_| indent + left.len() > WIDTH - SHORT) {
        head = format!("if ({})\n{:width$}", expression(condition, indent + 4, 1), "", width = indent + 2);
        (inner, target) = (indent + 2, rest);
    }
    let beside = expression(value, inner + target.len() + 1, tail.len());
    let fits = |text: &str| text.lines().next().is_some_and(|line| inner + target.len() + 1 + line.len() <= WIDTH);
    if !beside.contains('\n') && fits(&beside) {
        return format!("{head}{target} {beside}{tail}");
    }
    if bracket(value).is_some_and(|(open, _)| value[..=open].ends_with('{')) {
        return format!("{head}{target} {}{tail}", expression_at(value, inner, inner + target.len() + 1, tail.len()));
    }
    let below = inner + 4;
    let text = match rungs(value) {
        (rungs, last) if rungs.len() > 1 => ladder(&rungs, last, below, tail.len()),
        _ => expression(value, below, tail.len()),
    };
    format!("{head}{target}\n{:below$}{text}{tail}", "")
}

/// The condition of `if (…)` and what follows it.
fn condition(left: &str) -> Option<(&str, &str)> {
    let rest = left.strip_prefix("if (")?;
    let mut depth = 1_i32;
    for (at, character) in rest.char_indices() {
        depth += step(character);
        if depth == 0 {
            return Some((&rest[..at], rest[at + 1..].trim_start()));
        }
    }
    None
}

/// An expression that begins in the column `indent`; `tail` characters follow it in its last line.
fn expression(text: &str, indent: usize, tail: usize) -> String {
    expression_at(text, indent, indent, tail)
}

/// As [`expression`], beginning in `column`, with its other lines indented by `indent`.
fn expression_at(text: &str, indent: usize, column: usize, tail: usize) -> String {
    let separated = split(text, &[","]);
    let (rungs, last) = rungs(text);
    let is_ladder = separated.len() == 1 && rungs.len() >= LADDER;
    if column + text.len() + tail <= WIDTH && !is_ladder {
        return text.to_owned();
    }
    if separated.len() > 1 {
        return list(&separated, indent, tail);
    }
    if !rungs.is_empty() {
        return ladder(&rungs, last, indent, tail);
    }
    for operators in OPERATORS {
        let parts = split(text, operators);
        if parts.len() > 1 {
            return list(&parts, indent, tail);
        }
    }
    let Some((open, close)) = bracket(text) else { return text.to_owned() };
    let (before, inside, after) = (&text[..=open], &text[open + 1..close], &text[close..]);
    if before.ends_with('{') {
        let deeper = indent + 2;
        return format!("{before}\n{:deeper$}{}\n{:indent$}{after}", "", expression(inside, deeper, 0), "");
    }
    let start = column + before.len();
    format!("{before}{}{after}", expression(inside, start, tail + after.len()))
}

/// `condition ? value :` line by line.
fn ladder(rungs: &[(&str, &str)], last: &str, indent: usize, tail: usize) -> String {
    let widest = rungs.iter().map(|(condition, _)| condition.len()).max().unwrap_or(0);
    let aligned = if widest <= ALIGNED { widest } else { 0 };
    let mut out = String::new();
    for (condition, value) in rungs {
        let condition = format!("{:<aligned$}", expression(condition, indent, 2));
        let column = indent + condition.len() + 3;
        let beside = (!condition.contains('\n') && column + value.len() + 2 <= WIDTH).then_some(*value);
        out += &match beside {
            Some(value) => format!("{condition} ? {value} :\n{:indent$}", ""),
            None => {
                let below = indent + 4;
                format!("{condition} ?\n{:below$}{} :\n{:indent$}", "", expression(value, below, 2), "")
            }
        };
    }
    out + &expression(last, indent, tail)
}

/// Operands or elements: short ones share lines, others have their own.
fn list(parts: &[(&str, &str)], indent: usize, tail: usize) -> String {
    let shares = parts.iter().all(|(_, part)| part.len() <= SHORT);
    let mut out = String::new();
    let mut column = indent;
    for (number, (sign, part)) in parts.iter().enumerate() {
        // A comma ends a line, an operator begins one.
        let (before, gap) = match *sign {
            "" => (String::new(), 0),
            "," => (",".to_owned(), 1),
            _ => (String::new(), sign.len() + 2),
        };
        let tail = if number + 1 == parts.len() { tail } else { 1 };
        let fits = shares && column + before.len() + gap + part.len() + tail <= WIDTH;
        out += &before;
        if number > 0 && !fits {
            out += &format!("\n{:indent$}", "");
            column = indent;
        } else if number > 0 {
            out.push(' ');
            column += before.len() + 1;
        }
        let sign = if matches!(*sign, "" | ",") { String::new() } else { format!("{sign} ") };
        let text = expression(part, column + sign.len(), tail);
        column += sign.len() + text.len();
        out += &sign;
        out += &text;
    }
    out
}

/// Conditions with their values, and the value if none of them holds.
fn rungs(text: &str) -> (Vec<(&str, &str)>, &str) {
    let (mut found, mut rest) = (Vec::new(), text);
    while let Some(question) = outside(rest).find(|at| rest[*at..].starts_with(" ? ")) {
        let mut open = 0;
        let colon = outside(rest).filter(|at| *at > question).find(|at| {
            let (opens, closes) = (rest[*at..].starts_with(" ? "), rest[*at..].starts_with(" : "));
            open += i32::from(opens) - i32::from(closes);
            closes && open < 0
        });
        let Some(colon) = colon else { break };
        found.push((&rest[..question], &rest[question + 3..colon]));
        rest = &rest[colon + 3..];
    }
    (found, rest)
}

/// The parts between `signs` outside brackets, each with the sign before it.
fn split<'t>(text: &'t str, signs: &[&'t str]) -> Vec<(&'t str, &'t str)> {
    let (mut parts, mut start, mut before) = (Vec::new(), 0, "");
    for at in outside(text) {
        for sign in signs {
            let spaced = if *sign == "," { ", ".to_owned() } else { format!(" {sign} ") };
            if text[at..].starts_with(&spaced) {
                parts.push((before, &text[start..at]));
                (start, before) = (at + spaced.len(), *sign);
            }
        }
    }
    parts.push((before, &text[start..]));
    parts
}

/// The first bracket outside others, if what closes it ends the text but for `)`, `;` and `,`.
fn bracket(text: &str) -> Option<(usize, usize)> {
    let open = text.find(['(', '{'])?;
    let is_port = text.starts_with('.');
    if text[..open].contains(' ') && !is_port {
        return None;
    }
    let mut depth = 0;
    for (at, character) in text.char_indices().skip(open) {
        depth += step(character);
        if depth == 0 {
            return text[at + 1..].chars().all(|rest| matches!(rest, ')' | ';' | ',')).then_some((open, at));
        }
    }
    None
}

const fn step(character: char) -> i32 {
    match character {
        '(' | '{' | '[' => 1,
        ')' | '}' | ']' => -1,
        _ => 0,
    }
}

/// The places outside all brackets.
fn outside(text: &str) -> impl Iterator<Item = usize> + '_ {
    let mut depth = 0;
    text.char_indices().filter_map(move |(at, character)| {
        depth += step(character);
        (depth == 0).then_some(at)
    })
}
