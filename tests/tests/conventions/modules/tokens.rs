//! Rust source as tokens, as far as it takes to find names: no comments, literals without their text.

/// A name, `::`, any other mark, or a literal (whose text is empty).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Token<'a> {
    pub text: &'a str,
    /// From 1.
    pub line: usize,
}

/// The tokens of `source` that are not only for tests.
pub fn tokens(source: &str) -> Vec<Token<'_>> {
    let mut found = Vec::new();
    let (mut at, mut line) = (0, 1);
    while let Some(rest) = source.get(at..).filter(|rest| !rest.is_empty()) {
        let (text, length) = piece(rest);
        found.extend(text.map(|text| Token { text, line }));
        line += rest[..length].matches('\n').count();
        at += length;
    }
    without_tests(&found)
}

/// The token that `rest` begins with, none for blanks and comments, and how many bytes it takes.
fn piece(rest: &str) -> (Option<&str>, usize) {
    let run = |part: fn(char) -> bool| rest.find(|c| !part(c)).unwrap_or(rest.len());
    let is_name = |c: char| c.is_alphanumeric() || c == '_';
    if let Some(length) = string(rest) {
        return (Some(""), length);
    }
    match rest.chars().next().unwrap_or_default() {
        c if c.is_whitespace() => (None, run(char::is_whitespace)),
        '/' if rest.starts_with("//") => (None, rest.find('\n').unwrap_or(rest.len())),
        '/' if rest.starts_with("/*") => (None, block_comment(rest)),
        '\'' => (Some(""), quote(rest)),
        c if c.is_ascii_digit() => (Some(""), run(is_name)),
        c if is_name(c) => {
            let raw = if rest.starts_with("r#") { 2 } else { 0 };
            let length = raw + rest[raw..].find(|c| !is_name(c)).unwrap_or(rest.len() - raw);
            (Some(&rest[raw..length]), length)
        }
        ':' if rest.starts_with("::") => (Some("::"), 2),
        c => (Some(&rest[..c.len_utf8()]), c.len_utf8()),
    }
}

/// Bytes of the string literal that `rest` begins with, prefix and quotes included.
fn string(rest: &str) -> Option<usize> {
    let after = rest.trim_start_matches(['b', 'c', 'r']);
    let prefix = rest.len() - after.len();
    let hashes = after.len() - after.trim_start_matches('#').len();
    let body = after[hashes..].strip_prefix('"')?;
    if rest[..prefix].contains('r') {
        let end = format!("\"{}", "#".repeat(hashes));
        return Some(prefix + hashes + 1 + body.find(&end)? + end.len());
    }
    let mut escaped = false;
    let end = body.char_indices().find(|&(_, c)| {
        let ends = c == '"' && !escaped;
        escaped = c == '\\' && !escaped;
        ends
    })?;
    (hashes == 0).then_some(prefix + 1 + end.0 + 1)
}

/// Bytes of the character literal or lifetime that `rest` begins with.
fn quote(rest: &str) -> usize {
    let mut chars = rest.char_indices().skip(1);
    let (first, second) = (chars.next(), chars.next());
    match (first, second) {
        (Some((_, '\\')), _) => rest[3..].find('\'').map_or(rest.len(), |end| 3 + end + 1),
        (Some(_), Some((end, '\''))) => end + 1,
        _ => 1 + rest[1..].find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(rest.len() - 1),
    }
}

/// Bytes of the block comment that `rest` begins with; they nest.
fn block_comment(rest: &str) -> usize {
    let (mut at, mut depth) = (2, 1);
    while depth > 0 && at < rest.len() {
        match &rest.as_bytes()[at..] {
            [b'/', b'*', ..] => (at, depth) = (at + 2, depth + 1),
            [b'*', b'/', ..] => (at, depth) = (at + 2, depth - 1),
            _ => at += 1,
        }
    }
    at
}

/// Leaves out each item, field or arm under `#[cfg(test)]` or `#[cfg(all(test, …))]`; all of a file that begins with
/// `#![cfg(test)]`.
fn without_tests<'a>(tokens: &[Token<'a>]) -> Vec<Token<'a>> {
    let begins = |at: usize, text: &[&str]| {
        text.iter().enumerate().all(|(i, text)| tokens.get(at + i).is_some_and(|token| token.text == *text))
    };
    if begins(0, &["#", "!", "[", "cfg", "(", "test", ")"]) {
        return Vec::new();
    }
    let (mut kept, mut at) = (Vec::new(), 0);
    while at < tokens.len() {
        if begins(at, &["#", "[", "cfg", "(", "test", ")"])
            || begins(at, &["#", "[", "cfg", "(", "all", "(", "test"])
        {
            at = after_item(tokens, after_group(tokens, at + 1));
        } else {
            kept.push(tokens[at]);
            at += 1;
        }
    }
    kept
}

/// The index after the bracketed group that begins at or after `at`.
pub fn after_group(tokens: &[Token<'_>], mut at: usize) -> usize {
    let mut depth = 0;
    while let Some(token) = tokens.get(at) {
        at += 1;
        match token.text {
            "(" | "[" | "{" => depth += 1,
            ")" | "]" | "}" => depth -= 1,
            _ => continue,
        }
        if depth == 0 {
            break;
        }
    }
    at
}

/// The index after what an attribute before `at` belongs to.
fn after_item(tokens: &[Token<'_>], mut at: usize) -> usize {
    let text = |at: usize| tokens.get(at).map_or("", |token| token.text);
    while text(at) == "#" {
        at = after_group(tokens, at + 1);
    }
    let mut first = at;
    if text(first) == "pub" {
        first = if text(first + 1) == "(" { after_group(tokens, first + 1) } else { first + 1 };
    }
    let is_import = text(first) == "use";
    while at < tokens.len() {
        match text(at) {
            ";" | "," => return at + 1,
            ")" | "]" | "}" => return at,
            "{" if !is_import => return after_group(tokens, at),
            "(" | "[" | "{" => at = after_group(tokens, at),
            _ => at += 1,
        }
    }
    at
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(source: &str) -> Vec<&str> {
        tokens(source).into_iter().map(|token| token.text).collect()
    }

    #[test]
    fn comments_and_literals_hide_nothing_and_show_nothing() {
        let source = r####"a /* b /* c */ d */ "e\"" r#"f"# b'\'' 'g' '\\' h::<'i> // j
            k"####;
        assert_eq!(texts(source), ["a", "", "", "b", "", "", "", "h", "::", "<", "", ">", "k"]);
        assert_eq!(tokens("a\n\"\n\"\nb").last().map(|token| token.line), Some(4));
    }

    #[test]
    fn what_is_only_for_tests_is_left_out() {
        assert_eq!(texts("a #[cfg(test)] #[x] mod b { c } d"), ["a", "d"]);
        assert_eq!(texts("#[cfg(test)] pub(crate) use a::{b, c}; d"), ["d"]);
        assert_eq!(
            texts("#[cfg(test)] fn a(b: [u8; 3]) -> c { d } #[cfg(feature)] e"),
            ["#", "[", "cfg", "(", "feature", ")", "]", "e"]
        );
        assert_eq!(texts("#[cfg(test)] mod a; b"), ["b"]);
        assert_eq!(texts("#![cfg(test)] a"), [""; 0]);
    }
}
