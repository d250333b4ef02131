//! Reads finished pages, to find their ids, links and sources.

/// An attribute of a tag.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Attribute {
    /// The tag's name.
    pub tag: String,
    /// The attribute's name.
    pub name: String,
    /// Its value, with references resolved.
    pub value: String,
}

/// All attributes of a page that have a value, in order; scripts and comments are skipped.
pub fn attributes(html: &str) -> Vec<Attribute> {
    let mut found = Vec::new();
    let mut rest = html;
    while let Some(at) = rest.find('<') {
        rest = &rest[at + 1..];
        if let Some(comment) = rest.strip_prefix("!--") {
            rest = comment.split_once("-->").map_or("", |(_, after)| after);
            continue;
        }
        let name: String = rest.chars().take_while(char::is_ascii_alphanumeric).collect();
        if name.is_empty() {
            continue;
        }
        rest = tag(&rest[name.len()..], &name, &mut found);
        if ["script", "style"].contains(&&*name) {
            let end = format!("</{name}");
            rest = rest.find(&end).map_or("", |at| &rest[at..]);
        }
    }
    found
}

/// Reads a tag's attributes, and returns what follows the tag.
fn tag<'a>(mut rest: &'a str, tag: &str, found: &mut Vec<Attribute>) -> &'a str {
    loop {
        rest = rest.trim_start_matches(|c: char| c.is_whitespace() || c == '/');
        if rest.is_empty() || rest.starts_with('>') {
            return rest.get(1..).unwrap_or_default();
        }
        let ends = |c: char| c.is_whitespace() || ['=', '>', '/'].contains(&c);
        let (name, after) = rest.split_at(rest.find(ends).unwrap_or(rest.len()).max(1));
        let Some(value) = after.strip_prefix('=') else {
            rest = after;
            continue;
        };
        let (value, after) = match value.chars().next() {
            Some(mark @ ('"' | '\'')) => value[1..].split_once(mark).unwrap_or((&value[1..], "")),
            _ => value.split_at(
                value.find(|c: char| c.is_whitespace() || c == '>').unwrap_or(value.len()),
            ),
        };
        let value = if value.contains('&') {
            value.replace("&quot;", "\"").replace("&#39;", "'").replace("&amp;", "&")
        } else {
            value.to_owned()
        };
        found.push(Attribute { tag: tag.to_owned(), name: name.to_owned(), value });
        rest = after;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn attributes_are_found_and_scripts_are_not_read() {
        let html = "<!-- <a href=\"no\"> --><a class=x href='b.html#c'>1 < 2</a>\
                    <script>\"<img src='no'>\"</script><img alt=\"a > b\" src=\"i.png\"/>";
        let found = attributes(html);
        let found: Vec<(&str, &str, &str)> =
            found.iter().map(|a| (&*a.tag, &*a.name, &*a.value)).collect();
        let expected = [
            ("a", "class", "x"),
            ("a", "href", "b.html#c"),
            ("img", "alt", "a > b"),
            ("img", "src", "i.png"),
        ];
        assert_eq!(found, expected);
    }
}
