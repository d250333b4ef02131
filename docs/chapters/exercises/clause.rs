//! What an answer says: its clauses, the parts of a clause, and the words that matter in them.

/// Words that deny all that is said beside them.
const DENY_ALL: [&str; 6] = ["never", "none", "nothing", "neither", "nor", "cannot"];
/// Words that deny what follows them.
const DENY_REST: [&str; 5] = ["not", "no", "than", "instead", "except"];
/// Where `not` follows one of these, it denies what stands before it, too.
const AUXILIARIES: [&str; 14] = [
    "is", "are", "was", "were", "do", "does", "did", "has", "have", "had", "can", "will", "would",
    "should",
];
/// Words that mean nothing here.
const ARTICLES: [&str; 3] = ["a", "an", "the"];
/// Words between two things that are said.
const BETWEEN: [&str; 3] = ["but", "and", "yet"];
/// Words after which another thing is spoken of: what answers stands before them.
const ANOTHER: [&str; 4] = ["while", "whereas", "then", "before"];
/// What ends a sentence, or a part of one.
const STOPS: [char; 5] = ['.', ';', ':', '!', '?'];

/// A part of a clause, in which a denial holds.
pub struct Part {
    /// All its words.
    words: Vec<String>,
}

impl Part {
    /// The words that are not denied.
    pub fn said(&self) -> Vec<&str> {
        let all = || self.words.iter().map(|word| &**word);
        let Some(at) = self.words.iter().position(|word| denies(word)) else {
            return all().collect();
        };
        let before = at.checked_sub(1).map_or("", |before| &self.words[before]);
        let alone = DENY_REST.contains(&&*self.words[at]) && !AUXILIARIES.contains(&before);
        all().take(if alone { at } else { 0 }).collect()
    }

    /// Whether it says all words of a set.
    pub fn holds(&self, set: &[String]) -> bool {
        match set {
            // "No" is an answer, "no idea" is none.
            [only] if DENY_REST.contains(&&**only) => self.words == [only.as_str()],
            _ if set.iter().any(|key| denies(key)) => {
                set.iter().all(|key| self.words.contains(key))
            }
            _ => set.iter().all(|key| self.said().contains(&&**key)),
        }
    }
}

/// Whether a word denies others.
pub fn denies(word: &str) -> bool {
    DENY_ALL.contains(&word) || DENY_REST.contains(&word) || word.ends_with("n't")
}

/// The clauses of a text, in its order.
pub fn clauses(text: &str) -> Vec<String> {
    let mut clauses = vec![String::new()];
    for word in text.split_whitespace() {
        let plain = word.trim_end_matches(STOPS);
        let another = words(plain).iter().any(|word| ANOTHER.contains(&&**word));
        if let (false, Some(last)) = (another, clauses.last_mut()) {
            last.push_str(plain);
            last.push(' ');
        }
        if another || plain != word {
            clauses.push(String::new());
        }
    }
    clauses
}

/// The parts of a clause.
pub fn parts(clause: &str) -> Vec<Part> {
    let mut parts = vec![Vec::new()];
    for word in clause.split_whitespace() {
        let plain = words(word);
        if plain.iter().any(|word| BETWEEN.contains(&&**word)) {
            parts.push(Vec::new());
        } else if let Some(last) = parts.last_mut() {
            last.extend(plain);
        }
        if word.ends_with(',') {
            parts.push(Vec::new());
        }
    }
    parts.into_iter().filter(|words| !words.is_empty()).map(|words| Part { words }).collect()
}

/// The words of a text in small letters and the singular, without articles and what stands around them.
pub fn words(text: &str) -> Vec<String> {
    let text = text.to_lowercase().replace('−', "-").replace('’', "'").replace('=', " ");
    let split = text.split_whitespace().flat_map(|word| {
        let compound = word.contains('-') && !word.contains(|c: char| c.is_ascii_digit());
        word.split(if compound && !word.starts_with('-') { '-' } else { ' ' })
    });
    let plain = split.map(|word| {
        let word = word.trim_start_matches(|c: char| !c.is_alphanumeric() && !"+-".contains(c));
        let word = word.trim_end_matches(|c: char| !c.is_alphanumeric());
        singular(word.trim_end_matches("'s"))
    });
    plain.filter(|word| !word.is_empty() && !ARTICLES.contains(&&**word)).collect()
}

/// A word without the `s` of a plural or of a verb.
fn singular(word: &str) -> String {
    if AUXILIARIES.contains(&word) {
        return word.to_owned();
    }
    let long = ["xes", "oes", "shes", "ches", "sses"].iter().any(|end| word.ends_with(end));
    let short = word.ends_with('s') && !word.ends_with("ss") && word.len() > 3;
    word[..word.len() - if long && word.len() > 4 { 2 } else { usize::from(short) }].to_owned()
}
