//! A server's page for missing pages: it finds the way back from any depth, wherever the site is served.

use std::fs;
use std::io::{BufRead, BufReader, Write};
use std::net::{TcpListener, TcpStream};
use std::thread;

use crate::browser::Browser;
use crate::built;
use crate::drawing::{SCHEMES, prefers};
use crate::reading::checked;

/// Serves the site below `/name/`, like a code host, and its page for missing files with status 404.
fn served() -> u16 {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let port = listener.local_addr().unwrap().port();
    thread::spawn(move || {
        for stream in listener.incoming().flatten() {
            thread::spawn(move || answer(stream));
        }
    });
    port
}

fn answer(mut stream: TcpStream) {
    let mut lines = BufReader::new(stream.try_clone().unwrap()).lines().map_while(Result::ok);
    let asked = lines.next().unwrap_or_default();
    lines.take_while(|line| !line.is_empty()).for_each(drop);
    let path = asked.split(' ').nth(1).unwrap_or_default().split(['?', '#']).next().unwrap();
    let file = path.strip_prefix("/name/").map(|rest| built().folder.join(rest));
    let (status, file) = match file.filter(|file| file.is_file()) {
        Some(file) => ("200 OK", file),
        None => ("404 Not Found", built().folder.join("404.html")),
    };
    let body = fs::read(&file).unwrap();
    let kind = match file.extension().and_then(|extension| extension.to_str()) {
        Some("html") => "text/html; charset=utf-8",
        Some("css") => "text/css",
        Some("js") => "text/javascript",
        _ => "application/octet-stream",
    };
    let head = format!(
        "HTTP/1.1 {status}\r\nContent-Type: {kind}\r\nContent-Length: {}\r\nConnection: close\r\n\r\n",
        body.len()
    );
    // The browser may have closed the connection.
    let _ = stream.write_all(head.as_bytes()).and_then(|()| stream.write_all(&body));
}

#[test]
#[ignore = "nightly only: in a browser"]
fn where_there_is_no_page_a_link_leads_back_from_any_depth() {
    let port = served();
    let mut browser = Browser::start();
    browser.size(390, 844, true);
    for place in
        ["nothing.html", "images/nothing.png", "05_shadow_miss.html/soft/shadows/", "a/b/c/d"]
    {
        browser.open(&format!("http://127.0.0.1:{port}/name/{place}"));
        let back = browser.run(
            "(async () => {
                for (let tries = 0; tries < 200 && document.getElementById('back').hidden; tries++) {
                    await new Promise(done => setTimeout(done, 20));
                }
                return document.querySelector('#back a').href;
            })()",
        );
        let first = format!("http://127.0.0.1:{port}/name/index.html");
        assert_eq!(back, first, "{place}");
    }
    for scheme in SCHEMES {
        prefers(&mut browser, scheme);
        let wrong = checked(&mut browser).wrong;
        assert!(wrong.is_empty(), "{scheme}: {wrong:?}");
    }
    browser.follow("document.querySelector('#back a').click()");
    let title = browser.run("document.querySelector('h1.menu-title')?.textContent");
    assert!(title.as_str().is_some_and(|title| title.contains("Ray Tracing in Vulkan")), "{title}");
}

#[test]
fn the_page_for_no_page_takes_nothing_from_another_file() {
    let text = fs::read_to_string(built().folder.join("404.html")).unwrap();
    for other in ["src=", "<link", "@import", "url("] {
        assert!(!text.contains(other), "{other}");
    }
    // Without a script, it says where to go.
    assert!(text.contains("<p id=\"lost\">"));
}
