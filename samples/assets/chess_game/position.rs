//! A position of chess, and the rules: which moves there are, and what a move does.

use std::fmt::{Display, Formatter};

/// The kind of a piece.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    Pawn,
    Rook,
    Knight,
    Bishop,
    Queen,
    King,
}

/// The owner of a piece.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    White,
    Black,
}

/// A square: the file from a to h and the rank, each 0 to 7.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Square {
    pub file: i8,
    pub rank: i8,
}

/// A piece on the board; `number` identifies it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Man {
    pub kind: Kind,
    pub side: Side,
    pub number: usize,
}

/// From where to where, and what a pawn becomes that arrives at the last rank.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Move {
    pub from: Square,
    pub to: Square,
    pub becomes: Option<Kind>,
}

/// The effect of a move: the pieces that went, and the piece that was taken.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Played {
    pub man: Man,
    pub by: Move,
    pub taken: Option<Man>,
    /// The rook of a castling.
    pub rook: Option<(Man, Square, Square)>,
}

/// The pieces on their squares, the side to move, and the earlier moves that forbid or allow the next ones.
#[derive(Clone)]
pub struct Position {
    men: [Option<Man>; 64],
    pub turn: Side,
    /// Flags of the pieces that have moved: a king or a rook that has moved cannot castle.
    moved: [bool; 32],
    /// The square that a pawn has just passed over.
    passed: Option<Square>,
}

/// Every square, a1 first.
pub fn squares() -> impl Iterator<Item = Square> {
    (0..8).flat_map(|rank| (0..8).map(move |file| Square { file, rank }))
}

impl Square {
    fn index(self) -> usize {
        (8 * self.rank + self.file) as usize
    }

    fn stepped(self, (across, up): (i8, i8)) -> Option<Self> {
        let to = Self { file: self.file + across, rank: self.rank + up };
        ((0..8).contains(&to.file) && (0..8).contains(&to.rank)).then_some(to)
    }
}

const STRAIGHT: [(i8, i8); 4] = [(1, 0), (-1, 0), (0, 1), (0, -1)];
const DIAGONAL: [(i8, i8); 4] = [(1, 1), (1, -1), (-1, 1), (-1, -1)];
const LEAPS: [(i8, i8); 8] =
    [(1, 2), (2, 1), (2, -1), (1, -2), (-1, -2), (-2, -1), (-2, 1), (-1, 2)];

impl Position {
    /// The start of every game.
    pub fn start() -> Self {
        use Kind::{Bishop, King, Knight, Pawn, Queen, Rook};
        let back = [Rook, Knight, Bishop, Queen, King, Bishop, Knight, Rook];
        let rows = [(0, Side::White, back), (1, Side::White, [Pawn; 8])];
        let rows = rows.into_iter().chain([(6, Side::Black, [Pawn; 8]), (7, Side::Black, back)]);
        let mut men = [None; 64];
        for (number, (square, side, kind)) in rows
            .flat_map(|(rank, side, kinds)| (0..8).map(move |file| (rank, file, side, kinds)))
            .map(|(rank, file, side, kinds)| (8 * rank + file, side, kinds[file]))
            .enumerate()
        {
            men[square] = Some(Man { kind, side, number });
        }
        Self { men, turn: Side::White, moved: [false; 32], passed: None }
    }

    /// The piece on a square.
    pub fn at(&self, square: Square) -> Option<Man> {
        self.men[square.index()]
    }

    /// Makes a move.
    ///
    /// # Errors
    /// If the rules forbid it: why, and what they allow instead.
    pub fn play(&mut self, by: Move) -> Result<Played, String> {
        let Move { from, to, becomes } = by;
        let side = self.turn;
        let man = self.at(from).ok_or(format!("nothing stands on {from}; {side} is to move"))?;
        if man.side != side {
            return Err(format!(
                "the {} on {from} is {}'s, and {side} is to move",
                man.kind, man.side
            ));
        }
        if !self.allows(from, to) {
            return Err(self.refusal(man, from, to));
        }
        let arrives = man.kind == Kind::Pawn && (to.rank == 0 || to.rank == 7);
        match becomes {
            None if arrives => {
                Err(format!("a pawn that arrives at {to} becomes a piece: {from}-{to}=Q"))
            }
            Some(Kind::Pawn | Kind::King) => {
                Err("a pawn becomes a queen, rook, bishop or knight: =Q, =R, =B or =N".into())
            }
            Some(_) if !arrives => {
                Err(format!("only a pawn at the last rank becomes something; write {from}-{to}"))
            }
            _ => Ok(self.make(man, by)),
        }
    }

    fn refusal(&self, man: Man, from: Square, to: Square) -> String {
        let kind = man.kind;
        let why = if self.reaches(from, to) || self.castling(from, to).is_some() {
            format!("{from}-{to} would leave {}'s king attacked", man.side)
        } else {
            format!("the {kind} on {from} cannot go to {to}")
        };
        let list: Vec<_> =
            squares().filter(|&to| self.allows(from, to)).map(|to| to.to_string()).collect();
        if list.is_empty() {
            format!("{why}: it has no move here")
        } else {
            format!("{why}: it may go to {}", list.join(", "))
        }
    }

    /// Tests whether the side to move may go so.
    fn allows(&self, from: Square, to: Square) -> bool {
        let Some(man) = self.at(from).filter(|man| man.side == self.turn) else { return false };
        if !self.reaches(from, to) && self.castling(from, to).is_none() {
            return false;
        }
        let mut after = self.clone();
        after.make(man, Move { from, to, becomes: None });
        !after.is_attacked(man.side)
    }

    /// Returns whether the king of a side is on a square that another piece attacks.
    fn is_attacked(&self, side: Side) -> bool {
        let is_king = |man: Man| man.kind == Kind::King && man.side == side;
        let Some(king) = squares().find(|&at| self.at(at).is_some_and(is_king)) else {
            return false;
        };
        self.is_reached(king, side)
    }

    /// Tests whether a piece that is not of `side` reaches a square on which one of `side` stands, or would.
    fn is_reached(&self, square: Square, side: Side) -> bool {
        let mut with = self.clone();
        let stand_in = Man { kind: Kind::Pawn, side, number: 0 };
        with.men[square.index()].get_or_insert(stand_in);
        squares().any(|from| {
            with.at(from).is_some_and(|man| man.side != side) && with.reaches(from, square)
        })
    }

    /// Tests whether the piece on `from` goes so, kings' safety and castling aside.
    fn reaches(&self, from: Square, to: Square) -> bool {
        let Some(man) = self.at(from) else { return false };
        let there = self.at(to);
        if there.is_some_and(|there| there.side == man.side) {
            return false;
        }
        let by = (to.file - from.file, to.rank - from.rank);
        match man.kind {
            Kind::Pawn => self.pawn_reaches(man.side, from, to),
            Kind::Knight => LEAPS.contains(&by),
            Kind::King => by.0.abs().max(by.1.abs()) == 1,
            Kind::Rook => self.slides(from, to, &STRAIGHT),
            Kind::Bishop => self.slides(from, to, &DIAGONAL),
            Kind::Queen => self.slides(from, to, &STRAIGHT) || self.slides(from, to, &DIAGONAL),
        }
    }

    fn pawn_reaches(&self, side: Side, from: Square, to: Square) -> bool {
        let (up, home) = if side == Side::White { (1, 1) } else { (-1, 6) };
        let is_free = |square| self.at(square).is_none();
        match (to.file - from.file, (to.rank - from.rank) * up) {
            (0, 1) => is_free(to),
            (0, 2) => {
                let between = Square { rank: from.rank + up, ..from };
                from.rank == home && is_free(between) && is_free(to)
            }
            (-1 | 1, 1) => !is_free(to) || self.passed == Some(to),
            _ => false,
        }
    }

    fn slides(&self, from: Square, to: Square, ways: &[(i8, i8)]) -> bool {
        ways.iter().any(|&way| {
            let mut at = from;
            while let Some(next) = at.stepped(way) {
                if next == to {
                    return true;
                }
                if self.at(next).is_some() {
                    return false;
                }
                at = next;
            }
            false
        })
    }

    /// The rook's part of a king's move over two squares, if the king may castle so.
    fn castling(&self, from: Square, to: Square) -> Option<(Square, Square)> {
        let king = self.at(from).filter(|man| man.kind == Kind::King && !self.moved[man.number])?;
        if to.rank != from.rank || (to.file - from.file).abs() != 2 {
            return None;
        }
        let (corner, way) = if to.file > from.file { (7, 1) } else { (0, -1) };
        let corner = Square { file: corner, rank: from.rank };
        let rook = self.at(corner).filter(|man| man.kind == Kind::Rook && man.side == king.side)?;
        let over = Square { file: from.file + way, rank: from.rank };
        let is_clear = self.slides(corner, from, &STRAIGHT) && !self.moved[rook.number];
        let is_safe = [from, over, to].iter().all(|&square| !self.is_reached(square, king.side));
        (is_clear && is_safe).then_some((corner, over))
    }

    /// Does what a move that the rules allow does.
    fn make(&mut self, man: Man, by: Move) -> Played {
        let Move { from, to, becomes } = by;
        let rook = self.castling(from, to).filter(|_| !self.reaches(from, to));
        let is_pawn = man.kind == Kind::Pawn;
        let passing = is_pawn && self.passed == Some(to) && from.file != to.file;
        let victim = if passing { Square { file: to.file, rank: from.rank } } else { to };
        let taken = self.men[victim.index()].take();
        self.men[from.index()] = None;
        self.men[to.index()] = Some(Man { kind: becomes.unwrap_or(man.kind), ..man });
        self.moved[man.number] = true;
        let rook = rook.and_then(|(corner, over)| {
            let rook = self.men[corner.index()].take()?;
            self.men[over.index()] = Some(rook);
            self.moved[rook.number] = true;
            Some((rook, corner, over))
        });
        let leaps = is_pawn && (to.rank - from.rank).abs() == 2;
        self.passed = leaps.then_some(Square { rank: (from.rank + to.rank) / 2, ..from });
        self.turn = if self.turn == Side::White { Side::Black } else { Side::White };
        Played { man, by, taken, rook }
    }
}

impl Display for Square {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}{}", (b'a' + self.file as u8) as char, self.rank + 1)
    }
}

impl Display for Kind {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        f.write_str(["pawn", "rook", "knight", "bishop", "queen", "king"][*self as usize])
    }
}

impl Display for Side {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        f.write_str(["White", "Black"][*self as usize])
    }
}
